#include "materials/microfacet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/direction_test.h"

namespace gradslc {
namespace {

std::vector<Microfacet> surfaces() {
  std::vector<Microfacet> result;
  for (const MicrofacetType type : {MicrofacetType::beckmann, MicrofacetType::ggx})
    for (const auto& [u, v] : {std::pair{0.02f, 0.02f}, {0.1f, 0.1f}, {0.5f, 0.5f}, {1.6f, 1.6f}, {0.1f, 0.6f}})
      result.push_back({type, u, v});
  return result;
}

std::vector<Vec3> directions() {
  return {
      {0, 0, 1}, normalize(Vec3{0.5f, 0.2f, 0.8f}), normalize(Vec3{-1, 0.5f, 0.3f}), normalize(Vec3{0.13f, -1, 0.02f})};
}

/// Integral of `density`, 1/sr, over the normals of the upper hemisphere: midpoint rule over slopes (alpha_u t cos phi,
/// alpha_v t sin phi), t = x / (1 - x), whose solid angle is alpha_u alpha_v t dt dphi m.z^3.
template <class Density>
double integrate_over_facets(const Microfacet& surface, const Density& density) {
  constexpr int n_t = 1000, n_phi = 100;
  double sum = 0;
  for (int i = 0; i < n_t; ++i)
    for (int j = 0; j < n_phi; ++j) {
      const double x = (i + 0.5) / n_t, t = x / (1 - x), phi = 2 * k_pi * (j + 0.5) / n_phi;
      const double u = surface.alpha_u * t * std::cos(phi), v = surface.alpha_v * t * std::sin(phi);
      const double z = 1 / std::sqrt(1 + u * u + v * v);
      const Vec3 m{static_cast<float>(u * z), static_cast<float>(v * z), static_cast<float>(z)};
      sum += density(m) * surface.alpha_u * surface.alpha_v * t * z * z * z / ((1 - x) * (1 - x));
    }
  return sum * 2 * k_pi / (n_t * n_phi);
}

TEST(Microfacet, FacetsProjectToTheSurface) {  // the integral of D(m) m.z is 1
  for (const Microfacet& surface : surfaces())
    EXPECT_NEAR(integrate_over_facets(surface, [&](Vec3 m) { return surface.d(m) * m.z; }), 1, 1e-4)
        << surface.alpha_u << " " << surface.alpha_v;
}

TEST(Microfacet, VisibleFacetsProjectToWhatIsSeen) {  // the integral of G1 D(m) max(0, v.m) is v.z (Heitz 2014, eq. 14)
  for (const Microfacet& surface : surfaces())
    for (const Vec3 v : directions())
      EXPECT_NEAR(integrate_over_facets(surface, [&](Vec3 m) { return surface.visible_pdf_solid_angle(v, m); }), 1,
                  1e-3)
          << surface.alpha_u << " " << surface.alpha_v << " " << v.z;
}

// In coordinates in which every surface has roughness 1, so that no peak is narrower than a cell. False alarm 0.1 %.
TEST(Microfacet, SamplesVisibleFacets) {
  // The floor is for cells of which the quadrature misses a sliver at the edge of what is visible.
  constexpr float floor = 1e-6f;
  const std::size_t tests = surfaces().size() * directions().size();
  std::uint64_t seed = 1;
  for (const Microfacet& surface : surfaces())
    for (const Vec3 v : directions()) {
      const float u = surface.alpha_u, w = surface.alpha_v;
      const auto sample = [&](TestRandom& random) {
        const Vec3 m = surface.sample_visible(v, random.get2());
        return std::optional(normalize(Vec3{m.x / u, m.y / w, m.z}));
      };
      const auto pdf = [&](Vec3 stretched) {
        if (stretched.z <= 0) return floor;
        const Vec3 m = normalize(Vec3{u * stretched.x, w * stretched.y, stretched.z});
        const float z = m.z / stretched.z;  // slopes shrink by u and w; their solid angle is z^3 of their area
        return std::max(surface.visible_pdf_solid_angle(v, m) * u * w * z * z * z, floor);
      };
      const ChiSquare result =
          chi_square_directions(sample, pdf, {.cells_z = 16, .cells_phi = 24, .samples = 20'000, .seed = seed++});
      EXPECT_GT(result.p_value, sidak(1e-3, tests)) << u << " " << w << " " << v.z;
    }
}

TEST(Microfacet, HasKnownValues) {
  const Microfacet ggx{MicrofacetType::ggx, 0.5f, 0.5f}, beckmann{MicrofacetType::beckmann, 0.5f, 0.5f};
  EXPECT_NEAR(ggx.d({0, 0, 1}), 1 / (k_pi * 0.25f), 1e-5f);
  EXPECT_NEAR(beckmann.d({0, 0, 1}), 1 / (k_pi * 0.25f), 1e-5f);
  const Vec3 oblique = normalize(Vec3{1, 0, 1});  // 45 degrees, tan = 1
  EXPECT_NEAR(ggx.d(oblique), 4 * 0.25f / (k_pi * 1.25f * 1.25f), 1e-5f);
  EXPECT_NEAR(beckmann.d(oblique), 4 * std::exp(-4.0f) / (k_pi * 0.25f), 1e-5f);
  EXPECT_NEAR(ggx.g1(oblique), 2 / (1 + std::sqrt(1.25f)), 1e-5f);
  const float a = 2;  // 1 / (alpha tan), Walter et al. 2007
  EXPECT_NEAR(beckmann.g1(oblique), 2 / (1 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(k_pi))), 1e-5f);
  EXPECT_EQ(ggx.d({0, 0, -1}), 0);
}

TEST(Microfacet, HasLimitsAtTheHorizon) {
  for (const Microfacet& surface : surfaces()) {
    const float numerator = surface.type == MicrofacetType::ggx ? 2 : 2 * std::sqrt(k_pi);
    EXPECT_NEAR(surface.g1_over_cos({1, 0, 0}) * surface.alpha_u, numerator, 1e-5f);
    EXPECT_NEAR(surface.g1_over_cos({0, 1, 1e-7f}) * surface.alpha_v, numerator, 1e-4f);
    EXPECT_EQ(surface.g1({1, 0, 0}), 0);
    EXPECT_NEAR(surface.g1({0, 0, 1}), 1, 1e-6f);
    EXPECT_TRUE(std::isfinite(surface.d({1, 0, 1e-20f})));
  }
  const Microfacet mirror = Microfacet::make(MicrofacetType::ggx, 0, 0);
  EXPECT_EQ(mirror.alpha_u, Microfacet::k_min_alpha);
  EXPECT_TRUE(std::isfinite(mirror.d({0, 0, 1})));
  EXPECT_NEAR(mirror.sample_visible(normalize(Vec3{1, 1, 1}), {0.3f, 0.6f}).z, 1, 1e-5f);
}

TEST(Microfacet, BoundsAreBounds) {
  TestRandom random(3);
  for (const Microfacet& surface : surfaces())
    for (int i = 0; i < 20'000; ++i) {
      const Vec3 u = random.direction();
      const Vec3 m = normalize(Vec3{u.x, u.y, std::abs(u.z) * (i % 2 == 0 ? 1 : 20)});
      const float inclination = std::atan2(std::hypot(m.x, m.y), m.z), cos_other = random.get1();
      ASSERT_LE(surface.d(m), surface.max_d(inclination * random.get1()) * 1.0001f + 1e-30f);
      ASSERT_LE(surface.d(m), surface.max_d(inclination) * 1.001f + 1e-30f);
      ASSERT_LE(surface.g1_over_cos(m), surface.max_g1_over_cos(m.z, cos_other) * 1.0001f);
    }
}

}  // namespace
}  // namespace gradslc
