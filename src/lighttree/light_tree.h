#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lighttree/light_cluster.h"

namespace gradslc {

using NodeIndex = std::uint32_t;

/// Up to eight clusters side by side, as SIMD kernels read them (structure of arrays).
struct alignas(64) LightNode {
  static constexpr int k_width = 8;
  using Lanes = float[k_width];
  alignas(32) Lanes lower[3] = {}, upper[3] = {};          ///< boxes
  alignas(32) Lanes flux = {}, capped_flux = {};           ///< as in LightCluster; 0 in lanes without a child
  alignas(32) Lanes axis[3] = {}, cosine = {}, sine = {};  ///< cones of normals
  std::uint32_t child[k_width] = {};  ///< k_leaf | index of a VPL, or a node; k_none: no child in this lane

  static constexpr std::uint32_t k_leaf = 0x80000000u, k_none = 0xffffffffu;
  bool has_child(int lane) const { return child[lane] != k_none; }
  bool is_leaf(int lane) const { return (child[lane] & k_leaf) != 0; }
  std::uint32_t vpl(int lane) const { return child[lane] & ~k_leaf; }
  /// Children lie in the first lanes.
  int child_count() const { return static_cast<int>(std::find(child, child + k_width, k_none) - child); }
};

static_assert(sizeof(LightNode) == 448);

/// The glossy light of a node's eight clusters.
struct alignas(64) GlossyLanes {
  alignas(32) LightNode::Lanes peak = {}, tail = {}, alpha2 = {1, 1, 1, 1, 1, 1, 1, 1};
  alignas(32) LightNode::Lanes axis[3] = {}, cosine = {}, sine = {};
};
static_assert(sizeof(GlossyLanes) == 256);

/// A tree of clusters over a set of VPLs, eight children a node. Node 0 is the root; every node has a child, and every
/// VPL is one leaf.
struct LightTree {
  BulkVector<LightNode> nodes;
  BulkVector<GlossyLanes> gloss;  ///< of each node; empty where no VPL has a microfacet lobe
  VplSet set;                     ///< in tree order
  bool empty() const { return nodes.empty(); }
};

/// Writes a cluster to a lane of a node, and of its gloss unless null.
void set_lane(LightNode& node, GlossyLanes* gloss, int lane, const LightCluster& cluster, std::uint32_t child);
/// Makes the lanes from `lane` on ones without a child, and of the node's gloss unless null.
void clear_lanes(LightNode& node, GlossyLanes* gloss, int lane);
/// What set_lane() wrote.
LightCluster cluster_of_lane(const LightTree& tree, NodeIndex node, int lane);

struct BuilderEntry {
  const char* name;
  const char* meaning;
  LightTree (*build)(VplSet set);
  double (*resident_bytes)(const VplCounts&);  ///< expected, of the tree with its set
  double (*peak_bytes)(const VplCounts&);      ///< expected, while it is built
};
/// The only list of builders.
std::span<const BuilderEntry> builder_registry();
std::vector<std::string> builder_names();

}  // namespace gradslc
