// Lightcuts against the sum over all VPLs: the same VPLs and camera paths, pixel by pixel.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

constexpr RenderSettings k_settings{.max_depth = 5};
constexpr double k_light_paths = 600;

struct Rendered {
  RgbImage vpl, direct;
  std::map<std::string, double> counters;
};

Rendered render(const std::string& integrator, std::map<std::string, ParameterValue> parameters, const Scene& scene,
                std::uint32_t passes = 1) {
  parameters["vpl/light_paths"] = k_light_paths;
  const auto method = Method{"", integrator, std::move(parameters)}.make();
  method->prepare(scene, k_settings);
  Film film(scene.camera().resolution(), {.gradients = false, .parts = true});
  for (std::uint32_t pass = 0; pass < passes; ++pass) method->render_pass(pass, film);
  Rendered rendered{film.part(Part::vpl), film.part(Part::direct), {}};
  for (const auto& counter : method->statistics().counters) rendered.counters[counter.name] = counter.value;
  return rendered;
}

struct Errors {
  double mean_relative = 0;  ///< mean over pixels that any VPL lights of |estimate - exact| / exact
  double of_mean = 0;        ///< of the image's mean, relative
};
Errors errors_of(const RgbImage& estimate, const RgbImage& exact) {
  Errors errors;
  double sum = 0, difference = 0, lit = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const auto e = static_cast<double>(luminance(exact[i])), a = static_cast<double>(luminance(estimate[i]));
    if (e == 0) continue;
    errors.mean_relative += std::abs(a - e) / e;
    sum += e, difference += a - e, ++lit;
  }
  errors.mean_relative /= lit, errors.of_mean = difference / sum;
  return errors;
}

// The ratio limits every cluster's error by itself. Errors of a cut's clusters are of either sign, so that together
// they are some root of the cut's size times as large.
TEST(Lightcuts, ErrorIsWhatTheRatioAllowsAndFallsWithIt) {
  for (const bool glossy : {false, true}) {
    const Scene scene = glossy ? glossy_box({24, 24}) : test_box({24, 24}, {.mirror = true});
    const RgbImage exact = render("vpl", {}, scene).vpl;
    double error_before = 1, size_before = 0;
    for (const double ratio : {0.2, 0.05, 0.02, 0.005}) {
      const Rendered cut = render("lightcuts", {{"error_ratio", ratio}, {"max_cut_size", 100000.0}}, scene);
      const double size = cut.counters.at("mean_cut_size");
      const Errors errors = errors_of(cut.vpl, exact);
      SCOPED_TRACE(fmt::format("{} {}: mean error {}, of the mean {}, {} clusters", glossy ? "glossy" : "diffuse",
                               ratio, errors.mean_relative, errors.of_mean, size));
      EXPECT_LT(errors.mean_relative, 0.5 * ratio * std::sqrt(size));
      EXPECT_LT(errors.mean_relative, error_before);
      EXPECT_GT(size, size_before);
      error_before = errors.mean_relative, size_before = size;
    }
    EXPECT_LT(error_before, 0.03);
  }
}

// Over VPL sets and representatives the errors average out, but for the cuts' dependence on what representatives say.
TEST(Lightcuts, MeanOverSetsIsWithinTheRatio) {
  const Scene scene = test_box({16, 16}, {.mirror = true});
  constexpr double k_ratio = 0.02;
  constexpr std::uint32_t k_sets = 20;
  const RgbImage exact = render("vpl", {}, scene, k_sets).vpl;
  const RgbImage cut = render("lightcuts", {{"error_ratio", k_ratio}}, scene, k_sets).vpl;
  EXPECT_LT(std::abs(errors_of(cut, exact).of_mean), k_ratio);
}

TEST(Lightcuts, CutsAreNoLargerThanAllowedAndShadowRaysNoMoreThanRepresentatives) {
  const Scene scene = test_box({24, 24});
  const Rendered cut = render("lightcuts", {{"error_ratio", 0.001}, {"max_cut_size", 30.0}}, scene);
  EXPECT_LE(cut.counters.at("mean_cut_size"), 30);
  EXPECT_GT(cut.counters.at("mean_cut_size"), 20);
  EXPECT_LE(cut.counters.at("shadow_rays_per_gather"), cut.counters.at("representatives_per_gather"));
  EXPECT_GT(cut.counters.at("shadow_rays_per_gather"), 5);
  EXPECT_GT(cut.counters.at("gathers"), 300);
}

TEST(Lightcuts, FullCutIsTheSumOfAllVpls) {
  const Scene scene = glossy_box({16, 16});
  const RgbImage exact = render("vpl", {}, scene).vpl;
  const RgbImage cut = render("lightcuts", {{"error_ratio", 0.0}, {"max_cut_size", 100000.0}}, scene).vpl;
  for (std::size_t i = 0; i < cut.size(); ++i)
    EXPECT_NEAR(luminance(cut[i]), luminance(exact[i]), 2e-5f * (1 + luminance(exact[i])));
}

// Clusters of VPLs on the lamp and on walls are told apart by their representatives.
TEST(Lightcuts, FullCutIsTheSumOfAllVplsWithThoseOnEmitters) {
  const Scene scene = test_box({16, 16}, {.mirror = true});
  const Rendered exact = render("vpl", {{"vpl/direct", true}}, scene);
  const Rendered cut =
      render("lightcuts", {{"vpl/direct", true}, {"error_ratio", 0.0}, {"max_cut_size", 100000.0}}, scene);
  float direct = 0;
  for (std::size_t i = 0; i < cut.vpl.size(); ++i) {
    EXPECT_NEAR(luminance(cut.vpl[i]), luminance(exact.vpl[i]), 2e-5f * (1 + luminance(exact.vpl[i])));
    EXPECT_NEAR(luminance(cut.direct[i]), luminance(exact.direct[i]), 2e-5f * (1 + luminance(exact.direct[i])));
    direct += luminance(cut.direct[i]);
  }
  EXPECT_GT(direct, 0);
}

// Parts of mixed clusters follow their representatives: right on average over sets.
TEST(Lightcuts, PartsOfCoarseCutsAreRightOnAverage) {
  const Scene scene = test_box({16, 16}, {.mirror = true});
  constexpr double k_ratio = 0.02;
  constexpr std::uint32_t k_sets = 20;
  const Rendered exact = render("vpl", {{"vpl/direct", true}}, scene, k_sets);
  const Rendered cut = render("lightcuts", {{"vpl/direct", true}, {"error_ratio", k_ratio}}, scene, k_sets);
  EXPECT_LT(std::abs(errors_of(cut.vpl, exact.vpl).of_mean), k_ratio);
  EXPECT_LT(std::abs(errors_of(cut.direct, exact.direct).of_mean), k_ratio);
}

TEST(Lightcuts, SaysThatItIsBiased) {
  const auto method = Method{"", "lightcuts", {{"vpl/light_paths", 20.0}}}.make();
  const Scene scene = test_box({4, 4});
  method->prepare(scene, k_settings);
  EXPECT_TRUE(method->traits().biased);
}

}  // namespace
}  // namespace gradslc
