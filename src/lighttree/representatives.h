#pragma once

#include <array>
#include <vector>

#include "lighttree/bounds.h"

namespace gradslc {

/// One VPL for every cluster of a light tree, which stands for all of it (Walter et al. 2005, section 3). Each VPL
/// draws one number, exponentially distributed with its flux's luminance as the rate, and a cluster's representative is
/// the one with the smallest. So it is drawn in proportion to flux, for any cluster, and of the parts that a cluster is
/// split into the one that holds the representative keeps it. 96 bytes per node.
class Representatives {
 public:
  Representatives() = default;
  Representatives(const LightTree& tree, std::uint64_t seed);

  struct Representative {
    std::uint32_t vpl;  ///< index into the tree's set
    float flux;         ///< luminance, sum over the VPLs that it stands for
  };
  /// Of the children of a node that `lanes` holds, of which one must be there.
  Representative of(NodeIndex node, LaneMask lanes) const;

 private:
  struct Lane {
    float key;
    std::uint32_t vpl;
    float flux;
  };
  Lane merged(NodeIndex node, LaneMask lanes) const;

  std::vector<std::array<Lane, LightNode::k_width>> nodes_;
};

}  // namespace gradslc
