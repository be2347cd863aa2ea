#include "lighttree/representatives.h"

#include <cmath>

#include "core/hash.h"
#include "core/parallel.h"

namespace gradslc {
namespace {

/// Nodes from the root down, each level after the one above it.
struct Levels {
  std::vector<NodeIndex> nodes;
  std::vector<std::size_t> begins;  ///< of each level; the last is the end
};

Levels levels_of(const LightTree& tree) {
  Levels levels{.nodes = {0}, .begins = {0}};
  levels.nodes.reserve(tree.nodes.size());
  while (levels.begins.back() < levels.nodes.size()) {
    const std::size_t begin = levels.begins.back(), end = levels.nodes.size();
    for (std::size_t i = begin; i < end; ++i) {
      const LightNode& node = tree.nodes[levels.nodes[i]];
      for (int lane = 0; lane < LightNode::k_width; ++lane)
        if (node.has_child(lane) && !node.is_leaf(lane)) levels.nodes.push_back(node.child[lane]);
    }
    levels.begins.push_back(end);
  }
  return levels;
}

/// Exponentially distributed with rate `flux`; black VPLs come last.
float exponential_key(std::uint64_t seed, std::uint32_t vpl, float flux) {
  if (!(flux > 0)) return k_infinity;
  const double u = static_cast<double>((hash_combine(seed, vpl) >> 11) + 1) * 0x1p-53;  // in (0, 1]
  return static_cast<float>(-std::log(u) / static_cast<double>(flux));
}

}  // namespace

Representatives::Representatives(const LightTree& tree, std::uint64_t seed) : nodes_(tree.nodes.size()) {
  if (tree.empty()) return;
  const Levels levels = levels_of(tree);
  for (std::size_t level = levels.begins.size() - 1; level-- > 0;) {
    const std::size_t first = levels.begins[level];
    parallel_for(levels.begins[level + 1] - first, 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) {
        const LightNode& node = tree.nodes[levels.nodes[i]];
        for (int lane = 0; lane < LightNode::k_width; ++lane) {
          Lane& chosen = nodes_[levels.nodes[i]][static_cast<std::size_t>(lane)];
          if (!node.has_child(lane)) {
            chosen = {k_infinity, LightNode::k_none, 0};
          } else if (node.is_leaf(lane)) {
            const float flux = luminance(tree.set.vpls[node.vpl(lane)].flux);
            chosen = {exponential_key(seed, node.vpl(lane), flux), node.vpl(lane), flux};
          } else {
            chosen = merged(node.child[lane], k_all_lanes);
          }
        }
      }
    });
  }
}

Representatives::Lane Representatives::merged(NodeIndex node, LaneMask lanes) const {
  Lane merged{k_infinity, LightNode::k_none, 0};
  for (int lane = 0; lane < LightNode::k_width; ++lane) {
    if ((lanes >> lane & 1) == 0) continue;
    const Lane& other = nodes_[node][static_cast<std::size_t>(lane)];
    // Ties by index, so that a part which holds the representative keeps it.
    if (other.key < merged.key || (other.key == merged.key && other.vpl < merged.vpl))
      merged.key = other.key, merged.vpl = other.vpl;
    merged.flux += other.flux;
  }
  return merged;
}

Representatives::Representative Representatives::of(NodeIndex node, LaneMask lanes) const {
  const Lane lane = merged(node, lanes);
  return {lane.vpl, lane.flux};
}

}  // namespace gradslc
