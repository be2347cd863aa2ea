#pragma once

#include <array>
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
bool is_single_vpl(const LightTree& tree, const CutEntry& entry);

/// What an entry is refined into: two halves, or one entry for the same VPLs as a node's children. Parts of bound 0 are
/// left out.
struct CutParts {
  std::array<CutEntry, 2> parts;
  std::size_t count = 0;
  const CutEntry* begin() const { return parts.data(); }
  const CutEntry* end() const { return parts.data() + count; }
};

/// Makes the entries of cuts for some receivers. Appends to `evaluated`, which entries refer to.
class ClusterSplitter {
 public:
  ClusterSplitter(const LightTree& tree, std::span<const Receiver> receivers, float bound,
                  std::vector<ChildWeights>& evaluated)
      : tree_(tree), receivers_(receivers), bound_(bound), evaluated_(evaluated) {}

  /// All VPLs; nothing where none of them lights a receiver.
  CutParts root();
  /// `entry` must not be a single VPL.
  CutParts split(const CutEntry& entry);
  const LightTree& tree() const { return tree_; }

 private:
  void add_node(NodeIndex node, CutParts& parts);
  void add_lanes(NodeIndex node, LaneMask lanes, std::uint32_t evaluated, CutParts& parts) const;

  const LightTree& tree_;
  std::span<const Receiver> receivers_;
  float bound_;
  std::vector<ChildWeights>& evaluated_;
};

/// Clusters whose VPLs together are all that can light the receivers, each VPL in one of them.
struct LightCut {
  std::vector<CutEntry> entries;
  std::vector<ChildWeights> evaluated;  ///< weights of the nodes that entries are parts of
};

/// When a cut is fine enough.
struct CutLimits {
  int size = 1;     ///< most entries, >= 1
  float error = 0;  ///< >= 0; enough once no entry that could be refined has a bound above this share of all bounds
};

/// Refines the cut from the root: the entry with the largest bound is replaced by its halves until a limit is reached
/// or there are only VPLs. Entries of bound 0 are left out. Bounds only, never sampled values (DESIGN 5). An infinite
/// bound, as that of a box around a receiver with unbounded connections, is above any share. Reuses `cut`'s memory.
void find_cut(const LightTree& tree, std::span<const Receiver> receivers, float bound, const CutLimits& limits,
              LightCut& cut);

}  // namespace gradslc
