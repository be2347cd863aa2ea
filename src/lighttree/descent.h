#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "lighttree/bounds.h"

namespace gradslc {

struct DescentSample {
  std::uint32_t vpl;   ///< index into the tree's set
  double probability;  ///< > 0, given the start node
};

/// One VPL below `start`, by left_probability at every level (hierarchical descent, Yuksel 2019). `u` in [0,1) is
/// rescaled from level to level and therefore needs all bits of a double. nullopt: a dead branch was met, where nothing
/// can light the receivers. Adds to `node_evaluations`.
std::optional<DescentSample> descend(const LightTree& tree, NodeIndex start, std::span<const Receiver> receivers,
                                     float bound, double u, std::uint64_t& node_evaluations);

}  // namespace gradslc
