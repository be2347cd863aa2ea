#pragma once

#include <cstdint>
#include <vector>

#include "lighttree/tile_law.h"

namespace gradslc {

/// A VPL that a comb has hit.
struct Candidate {
  std::uint32_t vpl;    ///< index into the tree's set
  std::uint32_t count;  ///< points of the comb that fell on it, >= 1
  double probability;   ///< of one point: the expected count is the comb's size times this
};

/// Draws VPLs by a comb of `size` evenly spaced points that descend together (systematic sampling): each node is
/// visited once, and the points between its children are split by the law's weights and, for its power_share, by power:
/// p = (1 - power_share) p_law + power_share p_power for each VPL. So no candidate weighs more than the tree's power
/// over power_share, size and its own power, however wrong the law, which knows clusters by their boxes, may be. `u` in
/// [0,1) places the comb. Points that meet a dead branch are lost: nothing there lights any receiver. In the tree's
/// order. Returns the number of nodes weighed.
std::uint64_t draw_candidates(const LightTree& tree, const TileLaw& law, int size, double u,
                              std::vector<Candidate>& candidates);

}  // namespace gradslc
