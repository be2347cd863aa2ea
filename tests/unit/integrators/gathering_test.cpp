// Any number of compensation rays, rounded at random, brings what one ray brings; and so for next-event estimates.

#include "integrators/gathering.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/render/scenes.h"
#include "support/statistics.h"

namespace gradslc {
namespace {

/// Indirect light alone: no next-event estimation at x, so that all rays are those of compensation.
const RenderSettings k_indirect{
    .max_depth = 5, .components = {.emission = false, .direct = false}, .sampler = SamplerKind::independent};
const RenderSettings k_direct{
    .max_depth = 2, .components = {.emission = false, .indirect = false}, .sampler = SamplerKind::independent};

struct Gathered {
  Moments brought, rays;  ///< luminance, and rays over the mean number
};

Gathered gather(const Scene& scene, const RenderSettings& settings, const GatherEffort& effort, std::uint32_t samples) {
  const GatherSettings gather = make_gather_settings(scene, {}, 0.3f, settings.max_depth);
  Gathered gathered;
  for (std::uint32_t sample = 0; sample < samples; ++sample) {
    const auto stream =
        static_cast<std::uint64_t>(effort.rays * 1000) + 1000000 * static_cast<unsigned>(effort.emitters);
    PathContext context{scene, settings, LobeSelection(), SampleStream(settings.sampler, 3, stream, sample)};
    const CameraPrefix prefix = trace_camera_prefix(context, {5.5f, 9.5f});
    context.rays = 0;
    PartValues radiance;
    const auto [total, by_ray, by_emitters, by_draws] = gather_without_vpls(context, prefix, gather, radiance, effort);
    EXPECT_FLOAT_EQ(by_ray + by_emitters, luminance(radiance.total()));
    gathered.brought.add(static_cast<double>(by_ray + by_emitters));
    gathered.rays.add(static_cast<double>(context.rays) / static_cast<double>(effort.rays));
  }
  return gathered;
}

// False-alarm rate 0.1 % over all.
TEST(Gathering, AnyMeanNumberOfRaysHasTheMeanOfOne) {
  constexpr std::uint32_t k_samples = 20000;
  const Scene scene = test_box({12, 12});
  const Gathered one = gather(scene, k_indirect, {}, k_samples);
  EXPECT_LT(one.brought.standard_error(), 0.02 * one.brought.mean());
  const std::vector<float> means = {0.25f, 0.7f, 1.5f, 2, 4, 5.25f};
  const double level = sidak(0.001, 2 * means.size());
  for (const float mean_rays : means) {
    const Gathered many = gather(scene, k_indirect, {.rays = mean_rays}, k_samples);
    EXPECT_GT(same_mean_p_value(many.brought, one.brought), level)
        << mean_rays << ": " << many.brought.mean() << ", one ray brings " << one.brought.mean();
    EXPECT_GT(same_mean_p_value(many.rays, one.rays), level)
        << mean_rays << ": " << many.rays.mean() << " for each, " << one.rays.mean() << " alone";
  }
}

// Walls that shine are found by both alike: a wrong weight on either side moves the mean. False-alarm rate 0.1 % over
// all.
TEST(Gathering, AnyNumberOfNextEventEstimatesHasTheMeanOfOne) {
  constexpr std::uint32_t k_samples = 50000;
  const Scene scene = closed_furnace(Rgb(0.5f), {12, 12});
  const Gathered one = gather(scene, k_direct, {}, k_samples);
  EXPECT_LT(one.brought.standard_error(), 0.005 * one.brought.mean());
  const std::vector<GatherEffort> efforts = {{.rays = 1, .emitters = 2},
                                             {.rays = 0.25f, .emitters = 1},
                                             {.rays = 5.5f, .emitters = 1},
                                             {.rays = 0.5f, .emitters = 7},
                                             {.rays = 4, .emitters = 3}};
  const double level = sidak(0.001, efforts.size());
  for (const GatherEffort& effort : efforts) {
    const Gathered many = gather(scene, k_direct, effort, k_samples);
    EXPECT_GT(same_mean_p_value(many.brought, one.brought), level)
        << effort.rays << " rays, " << effort.emitters << " estimates: " << many.brought.mean()
        << ", one of each brings " << one.brought.mean();
  }
}

// Samples that repeat each other would be no bias, and no use.
TEST(Gathering, RaysAreIndependentOfEachOther) {
  constexpr std::uint32_t k_samples = 20000;
  const Scene scene = test_box({12, 12});
  const double one = gather(scene, k_indirect, {}, k_samples).brought.variance(),
               four = gather(scene, k_indirect, {.rays = 4}, k_samples).brought.variance();
  EXPECT_NEAR(four / one, 0.25, 0.025);
}

}  // namespace
}  // namespace gradslc
