#include "support/direction_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace gradslc {
namespace {

/// Part of the sphere between two heights and two azimuths; its solid angle is (z1 - z0) (phi1 - phi0).
struct Cell {
  double z0, z1, phi0, phi1;
};

Vec3 direction(double z, double phi) {
  const double radius = std::sqrt(std::max(0.0, 1 - z * z));
  return {static_cast<float>(radius * std::cos(phi)), static_cast<float>(radius * std::sin(phi)),
          static_cast<float>(z)};
}

double gauss_legendre(const std::function<double(Vec3)>& density, const Cell& cell) {
  // Three points on [-1,1] (Abramowitz and Stegun, table 25.4); none lies on the border.
  constexpr std::array nodes{-0.774596669241483377, 0.0, 0.774596669241483377};
  constexpr std::array weights{5.0 / 9, 8.0 / 9, 5.0 / 9};
  const double half_z = (cell.z1 - cell.z0) / 2, half_phi = (cell.phi1 - cell.phi0) / 2;
  double sum = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j)
      sum += weights[i] * weights[j] *
             density(direction(cell.z0 + half_z * (1 + nodes[i]), cell.phi0 + half_phi * (1 + nodes[j])));
  return sum * half_z * half_phi;
}

double integrate(const std::function<double(Vec3)>& density, const Cell& cell, double whole, int depth) {
  constexpr double relative_error = 1e-4, absolute_error = 1e-8;
  const double z = (cell.z0 + cell.z1) / 2, phi = (cell.phi0 + cell.phi1) / 2;
  const std::array quarters{Cell{cell.z0, z, cell.phi0, phi}, Cell{cell.z0, z, phi, cell.phi1},
                            Cell{z, cell.z1, cell.phi0, phi}, Cell{z, cell.z1, phi, cell.phi1}};
  std::array<double, 4> parts{};
  std::transform(quarters.begin(), quarters.end(), parts.begin(),
                 [&](const Cell& quarter) { return gauss_legendre(density, quarter); });
  const double sum = parts[0] + parts[1] + parts[2] + parts[3];
  if (depth == 0 || std::abs(sum - whole) <= relative_error * sum + absolute_error) return sum;
  double refined = 0;
  for (std::size_t i = 0; i < quarters.size(); ++i) refined += integrate(density, quarters[i], parts[i], depth - 1);
  return refined;
}

/// Probability of each cell of a grid of cells_z rows and cells_phi columns.
std::vector<double> integrate_cells(const std::function<double(Vec3)>& density, int cells_z, int cells_phi) {
  constexpr int max_depth = 8;
  std::vector<double> integrals;
  for (int row = 0; row < cells_z; ++row)
    for (int column = 0; column < cells_phi; ++column) {
      const Cell cell{2.0 * row / cells_z - 1, 2.0 * (row + 1) / cells_z - 1, 2 * std::numbers::pi * column / cells_phi,
                      2 * std::numbers::pi * (column + 1) / cells_phi};
      integrals.push_back(integrate(density, cell, gauss_legendre(density, cell), max_depth));
    }
  return integrals;
}

std::size_t cell_index(Vec3 w, int cells_z, int cells_phi) {
  double phi = std::atan2(w.y, w.x) / (2 * std::numbers::pi);
  if (phi < 0) phi += 1;
  const int row = std::clamp(static_cast<int>((w.z + 1.0) / 2 * cells_z), 0, cells_z - 1);
  const int column = std::clamp(static_cast<int>(phi * cells_phi), 0, cells_phi - 1);
  return static_cast<std::size_t>(row * cells_phi + column);
}

}  // namespace

double integrate_over_sphere(const std::function<double(Vec3)>& density) {
  double sum = 0;
  for (const double part : integrate_cells(density, 20, 40)) sum += part;
  return sum;
}

ChiSquare chi_square_directions(const std::function<std::optional<Vec3>(TestRandom&)>& sample,
                                const std::function<double(Vec3)>& pdf_solid_angle, const DirectionTest& test) {
  std::vector<double> expected = integrate_cells(pdf_solid_angle, test.cells_z, test.cells_phi);
  double missing = 1;
  for (double& probability : expected) {
    missing -= probability;
    probability *= static_cast<double>(test.samples);
  }
  constexpr double rounding = 1e-7;  // samples may fail where u is 0 or nearly 1, with probability 2^-24
  expected.push_back(std::max(missing, rounding) * static_cast<double>(test.samples));

  std::vector<double> observed(expected.size(), 0.0);
  TestRandom random(test.seed);
  for (std::size_t i = 0; i < test.samples; ++i) {
    const std::optional<Vec3> w = sample(random);
    observed[w ? cell_index(*w, test.cells_z, test.cells_phi) : observed.size() - 1] += 1;
  }
  return chi_square_test(observed, expected);
}

}  // namespace gradslc
