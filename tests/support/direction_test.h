#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/vec.h"
#include "support/random.h"
#include "support/statistics.h"

namespace gradslc {

struct DirectionTest {
  int cells_z = 20;  ///< even, so that the equator is a border between cells
  int cells_phi = 40;
  std::size_t samples = 200'000;
  std::uint64_t seed = 1;
};

/// Integral of `density` over the unit sphere, 1/sr times sr, by adaptive Gauss-Legendre quadrature.
double integrate_over_sphere(const std::function<double(Vec3)>& density);

/// Tests that directions follow their density: counts in cells of equal solid angle (z times azimuth) against the
/// integral of `pdf_solid_angle` over each cell. What `sample` fails to give (nullopt) must be what the density lacks
/// to
/// 1. `sample` draws from the TestRandom and returns unit vectors.
ChiSquare chi_square_directions(const std::function<std::optional<Vec3>(TestRandom&)>& sample,
                                const std::function<double(Vec3)>& pdf_solid_angle, const DirectionTest& test = {});

}  // namespace gradslc
