#pragma once
// Methods for tests: an integrator by name with parameters set, and its block means over many independent runs.

#include <map>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "integrators/integrator.h"
#include "support/statistics.h"

namespace gradslc {

using ParameterValue = std::variant<bool, double, std::string>;

/// A method of the registry; keys of nested objects are joined by '/'. Unknown keys and values are an assertion
/// failure.
struct Method {
  std::string label, integrator;
  std::map<std::string, ParameterValue> parameters;

  std::unique_ptr<Integrator> make() const;
};

/// What is compared: the image, its parts, or its differences.
enum class Quantity : std::uint8_t { image, direct, vpl, compensation, specular, prefix, vpl_and_compensation, dx, dy };
std::string to_string(Quantity quantity);

/// Luminance of the mean of every block of `block` x `block` pixels, for each of `runs` runs with seeds of their own:
/// one Moments per block, row by row. Gradients: only pairs that the film records, averaged over the block.
struct BlockMoments {
  std::map<Quantity, std::vector<Moments>> blocks;
};
struct BlockOptions {
  int runs = 64, passes = 4, block = 8;
  std::uint64_t seed = 1;
};
/// A partition of an image: of each pixel, the region that it belongs to.
struct Regions {
  Image<std::size_t> of;
  std::size_t count = 0;
};
Regions block_regions(Resolution resolution, int block);

/// The same over any regions, for each of several partitions.
std::vector<BlockMoments> region_moments(const Method& method, const Scene& scene, const RenderSettings& settings,
                                         std::span<const Regions> partitions, const BlockOptions& options);
BlockMoments block_moments(const Method& method, const Scene& scene, const RenderSettings& settings,
                           const BlockOptions& options);

/// Smallest p-value over blocks of "both have the same expectation", and the number of blocks compared.
struct Comparison {
  double p_value = 1;
  std::size_t tests = 0, block = 0;
  double mean_a = 0, mean_b = 0;  ///< of the block with that p-value
};
Comparison compare_blocks(const std::vector<Moments>& a, const std::vector<Moments>& b);

}  // namespace gradslc
