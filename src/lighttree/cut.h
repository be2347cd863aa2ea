#pragma once

#include <span>
#include <vector>

#include "lighttree/bounds.h"

namespace gradslc {

/// A set of nodes whose VPLs together are all that can light the receivers, each VPL in one node.
struct LightCut {
  struct Entry {
    NodeIndex node;
    float bound;
  };
  std::vector<Entry> entries;
  std::uint64_t node_evaluations = 0;  ///< calls of cluster_bound, summed over the cut's uses
};

/// Refines the cut from the root: the node with the largest bound is replaced by its children until there are
/// `cut_size` nodes (>= 1) or only leaves. Nodes of bound 0 are left out. Bounds only, never sampled values (DESIGN 5).
/// Reuses `cut`'s memory.
void find_cut(const LightTree& tree, std::span<const Receiver> receivers, float bound, int cut_size, LightCut& cut);

}  // namespace gradslc
