// Any number of compensation rays, rounded at random, brings what one ray brings.

#include "integrators/gathering.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/render/scenes.h"
#include "support/statistics.h"

namespace gradslc {
namespace {

/// Indirect light alone: no next-event estimation at x, so that all rays are those of compensation.
const RenderSettings& settings() {
  static const RenderSettings k_settings{
      .max_depth = 5, .components = {.emission = false, .direct = false}, .sampler = SamplerKind::independent};
  return k_settings;
}

struct Gathered {
  Moments brought, rays;  ///< luminance, and rays over the mean number
};

Gathered gather(const Scene& scene, float mean_rays, std::uint32_t samples) {
  const GatherSettings gather = make_gather_settings(scene, {}, 0.3f, settings().max_depth);
  Gathered gathered;
  for (std::uint32_t sample = 0; sample < samples; ++sample) {
    const auto stream = static_cast<std::uint64_t>(mean_rays * 1000);
    PathContext context{scene, settings(), LobeSelection(), SampleStream(settings().sampler, 3, stream, sample)};
    const CameraPrefix prefix = trace_camera_prefix(context, {5.5f, 9.5f});
    context.rays = 0;
    PartValues radiance;
    const float brought = gather_without_vpls(context, prefix, gather, radiance, mean_rays);
    EXPECT_FLOAT_EQ(brought, luminance(radiance.total()));
    gathered.brought.add(static_cast<double>(brought));
    gathered.rays.add(static_cast<double>(context.rays) / static_cast<double>(mean_rays));
  }
  return gathered;
}

// False-alarm rate 0.1 % over all.
TEST(Gathering, AnyMeanNumberOfRaysHasTheMeanOfOne) {
  constexpr std::uint32_t k_samples = 20000;
  const Scene scene = test_box({12, 12});
  const Gathered one = gather(scene, 1, k_samples);
  EXPECT_LT(one.brought.standard_error(), 0.02 * one.brought.mean());
  const std::vector<float> means = {0.25f, 0.7f, 1.5f, 2, 4, 5.25f};
  const double level = sidak(0.001, 2 * means.size());
  for (const float mean_rays : means) {
    const Gathered many = gather(scene, mean_rays, k_samples);
    EXPECT_GT(same_mean_p_value(many.brought, one.brought), level)
        << mean_rays << ": " << many.brought.mean() << ", one ray brings " << one.brought.mean();
    EXPECT_GT(same_mean_p_value(many.rays, one.rays), level)
        << mean_rays << ": " << many.rays.mean() << " for each, " << one.rays.mean() << " alone";
  }
}

// Rays that repeat each other would be no bias, and no use.
TEST(Gathering, RaysAreIndependentOfEachOther) {
  constexpr std::uint32_t k_samples = 20000;
  const Scene scene = test_box({12, 12});
  const double one = gather(scene, 1, k_samples).brought.variance(),
               four = gather(scene, 4, k_samples).brought.variance();
  EXPECT_NEAR(four / one, 0.25, 0.025);
}

}  // namespace
}  // namespace gradslc
