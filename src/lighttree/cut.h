#pragma once

#include <span>
#include <vector>

#include "lighttree/bounds.h"

namespace gradslc {

/// A cluster of a cut: some children of a node that has been evaluated. A cut is refined by halves, as if the tree were
/// binary; only a single child needs its own node's children evaluated.
struct CutEntry {
  NodeIndex node;
  LaneMask lanes;           ///< at least one, without gaps among the node's children
  std::uint32_t evaluated;  ///< index into LightCut::evaluated
  float bound;              ///< sum of the lanes' bounds, > 0
};

/// Clusters whose VPLs together are all that can light the receivers, each VPL in one of them.
struct LightCut {
  std::vector<CutEntry> entries;
  std::vector<ChildWeights> evaluated;  ///< weights of the nodes that entries are parts of
};

/// Refines the cut from the root: the entry with the largest bound is replaced by its halves until there are
/// `cut_size` entries (>= 1) or only VPLs. Entries of bound 0 are left out. Bounds only, never sampled values
/// (DESIGN 5). Reuses `cut`'s memory.
void find_cut(const LightTree& tree, std::span<const Receiver> receivers, float bound, int cut_size, LightCut& cut);

}  // namespace gradslc
