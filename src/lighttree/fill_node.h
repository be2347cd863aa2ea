#pragma once

#include "lighttree/light_tree.h"

namespace gradslc {

/// Room for `count` nodes, and their gloss where the set has any; to be filled.
void resize_nodes(LightTree& tree, std::size_t count);

/// Of one node.
constexpr double node_bytes(const VplCounts& counts) {
  return sizeof(LightNode) + (counts.surfaces > 0 ? sizeof(GlossyLanes) : 0);
}

/// Makes VPLs `first` and after it, `count` of them in 1..8, the children of a node. With SIMD where they are Lambert;
/// make_cluster() is the scalar twin.
void fill_leaf_node(LightTree& tree, NodeIndex node, std::uint32_t first, int count);

/// Makes 1..8 nodes that have been filled the children of another.
void fill_inner_node(LightTree& tree, NodeIndex node, std::span<const NodeIndex> children);

/// Everything below a node as one cluster, from the node's lanes.
LightCluster merge_lanes(const LightTree& tree, NodeIndex node);

}  // namespace gradslc
