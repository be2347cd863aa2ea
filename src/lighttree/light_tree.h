#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bounds.h"
#include "vpl/vpl.h"

namespace gradslc {

using NodeIndex = std::uint32_t;

/// A cluster of VPLs.
struct LightNode {
  Bounds3 box;
  float flux = 0;         ///< sum of bounds of pi f_c(y) flux, luminance
  float capped_flux = 0;  ///< sum of the same over max pi f_c(y): times b / pi^2, a bound of bounded connections
  /// Unit. Towards a direction at angle a to the axis, the VPLs' cosines are at most cos(max(0, a - h)), h the cone's
  /// half angle: it holds the geometric normals, and more where shading normals differ or light leaves on both sides.
  Vec3 cone_axis{0, 0, 1};
  float cone_cos = 1;   ///< cosine of its half angle, in [-1, 1]
  NodeIndex left = 0;   ///< inner node: its children; leaf: left is the VPL's index in the set
  NodeIndex right = 0;  ///< 0 at a leaf (the root is nobody's child)
  bool is_leaf() const { return right == 0; }
};

/// A binary tree over a set of VPLs, in tree order. Node 0 is the root; no nodes without VPLs.
struct LightTree {
  std::vector<LightNode> nodes;
  VplSet set;
  bool empty() const { return nodes.empty(); }
};

/// A leaf for one VPL.
LightNode make_leaf(const VplSet& set, std::uint32_t vpl_index);
/// An inner node with the bounds of both children.
LightNode merge_nodes(const LightNode& a, const LightNode& b, NodeIndex left, NodeIndex right);

struct BuilderEntry {
  const char* name;
  const char* meaning;
  LightTree (*build)(VplSet set);
};
/// The only list of builders.
std::span<const BuilderEntry> builder_registry();
std::vector<std::string> builder_names();

}  // namespace gradslc
