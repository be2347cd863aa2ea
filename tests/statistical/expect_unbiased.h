#pragma once
// Methods against path tracing: what every test of unbiasedness does.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "scene/scene.h"
#include "support/render/method.h"

namespace gradslc {

struct UnbiasedOptions {
  BlockOptions methods{.runs = 32, .passes = 4, .block = 8, .seed = 5};
  BlockOptions reference{.runs = 32, .passes = 32, .block = 8, .seed = 6};
  double false_alarm = 0.001;  ///< over all methods, quantities and regions
};

/// Expects that every method has spt's mean: of the image, dx and dy in each block, and of each part over the whole
/// image. In a block a part may be so rare (a mirror's image of the lamp, on pixels that share random numbers) that the
/// scatter of 32 runs does not show its tail, and a t-test raises false alarms.
inline void expect_unbiased(const Scene& scene, const RenderSettings& settings, const std::vector<Method>& methods,
                            const UnbiasedOptions& options = {}) {
  const Resolution resolution = scene.camera().resolution();
  const Regions partitions[] = {block_regions(resolution, options.methods.block),
                                block_regions(resolution, std::max(resolution.width, resolution.height))};
  struct Tested {
    std::size_t partition;
    Quantity quantity;
  };
  // spt writes vpl and compensation as one.
  constexpr Tested k_tested[] = {{0, Quantity::image},
                                 {0, Quantity::dx},
                                 {0, Quantity::dy},
                                 {1, Quantity::direct},
                                 {1, Quantity::vpl_and_compensation},
                                 {1, Quantity::specular},
                                 {1, Quantity::prefix}};
  std::size_t tests = 0;
  for (const Tested& tested : k_tested) tests += methods.size() * partitions[tested.partition].count;

  const auto reference = region_moments({"spt", "spt", {}}, scene, settings, partitions, options.reference);
  for (const Method& method : methods) {
    const auto moments = region_moments(method, scene, settings, partitions, options.methods);
    for (const auto& [partition, quantity] : k_tested) {
      const Comparison c =
          compare_blocks(moments[partition].blocks.at(quantity), reference[partition].blocks.at(quantity));
      EXPECT_GT(c.p_value, sidak(options.false_alarm, tests))
          << fmt::format("{}, {}: region {} has {} where spt has {}, p = {:.2g}", method.label, to_string(quantity),
                         c.block, c.mean_a, c.mean_b, c.p_value);
    }
  }
}

}  // namespace gradslc
