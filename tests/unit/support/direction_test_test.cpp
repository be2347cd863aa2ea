#include "support/direction_test.h"

#include <gtest/gtest.h>

#include "core/warp.h"

namespace gradslc {
namespace {

std::optional<Vec3> cosine(TestRandom& random) { return square_to_cosine_hemisphere(random.get2()); }
double cosine_pdf(Vec3 w) { return cosine_hemisphere_pdf_solid_angle(w.z); }

TEST(IntegrateOverSphere, OfKnownIntegrals) {
  EXPECT_NEAR(integrate_over_sphere([](Vec3) { return 1.0; }), 4 * k_pi, 1e-5);
  EXPECT_NEAR(integrate_over_sphere(cosine_pdf), 1, 1e-6);
  EXPECT_NEAR(integrate_over_sphere([](Vec3 w) { return double{w.x} * w.x * w.z * w.z; }), 4 * k_pi / 15, 1e-5);
  // A narrow cone whose border cuts cells: solid angle 2 pi (1 - cos).
  const Vec3 axis = normalize(Vec3{1, 2, 3});
  EXPECT_NEAR(integrate_over_sphere([&](Vec3 w) { return dot(w, axis) > 0.99f ? 1.0 : 0.0; }), 2 * k_pi * 0.01, 2e-4);
}

TEST(ChiSquareDirections, AcceptsWhatMatches) {
  EXPECT_GT(chi_square_directions(cosine, cosine_pdf).p_value, 1e-3);
  EXPECT_GT(
      chi_square_directions([](TestRandom& random) { return random.direction(); }, [](Vec3) { return k_inv_pi / 4; })
          .p_value,
      1e-3);
}

TEST(ChiSquareDirections, AcceptsFailuresThatTheDensityLacks) {
  const auto half = [](TestRandom& random) { return random.get1() < 0.5f ? cosine(random) : std::nullopt; };
  EXPECT_GT(chi_square_directions(half, [](Vec3 w) { return cosine_pdf(w) / 2; }).p_value, 1e-3);
}

TEST(ChiSquareDirections, RejectsWhatDiffers) {
  const auto uniform = [](Vec3 w) { return w.z > 0 ? k_inv_pi / 2 : 0.0; };
  const auto tilted = [](Vec3 w) { return cosine_pdf(w) * (1 + 0.1 * w.x); };
  const auto failing = [](TestRandom& random) { return random.get1() < 0.99f ? cosine(random) : std::nullopt; };
  const auto twice = [](Vec3 w) { return 2 * cosine_pdf(w); };
  EXPECT_LT(chi_square_directions(cosine, uniform).p_value, 1e-6);
  EXPECT_LT(chi_square_directions(cosine, tilted).p_value, 1e-6);
  EXPECT_LT(chi_square_directions(failing, cosine_pdf).p_value, 1e-6);
  EXPECT_LT(chi_square_directions(cosine, twice).p_value, 1e-6);
}

}  // namespace
}  // namespace gradslc
