#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "lighttree/cut.h"

namespace gradslc {

struct DescentSample {
  std::uint32_t vpl;   ///< index into the tree's set
  double probability;  ///< > 0, given the entry
};

/// One VPL below an entry of a cut, by child_probabilities() at every level (hierarchical descent, Yuksel 2019). `u` in
/// [0,1) is rescaled from level to level and therefore needs all bits of a double. nullopt: a dead branch was met,
/// where nothing can light the receivers. Adds to `node_evaluations`.
std::optional<DescentSample> descend(const LightTree& tree, const LightCut& cut, const CutEntry& entry,
                                     std::span<const Receiver> receivers, float bound, double u,
                                     std::uint64_t& node_evaluations);

}  // namespace gradslc
