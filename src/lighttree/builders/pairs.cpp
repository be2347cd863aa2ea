#include "lighttree/builders/pairs.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include "core/parallel.h"
#include "core/radix_sort.h"

namespace gradslc {
namespace {

constexpr std::size_t k_grain = 4096;

/// Spreads 21 bits to every third position.
std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// 63-bit Morton code of a point in a box: the axes' bits interleaved. Axes without extent give 0.
std::uint64_t morton_code(Point3 p, const Bounds3& box) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = static_cast<double>(box.upper[axis]) - static_cast<double>(box.lower[axis]);
    if (!(extent > 0)) continue;
    const double unit = (static_cast<double>(p[axis]) - static_cast<double>(box.lower[axis])) / extent;
    const auto cell = static_cast<std::uint64_t>(std::clamp(unit * 0x1p21, 0.0, 0x1p21 - 1));
    code |= spread_bits(cell) << axis;
  }
  return code;
}

std::vector<Vpl> in_morton_order(const std::vector<Vpl>& vpls) {
  Bounds3 box;
  for (const Vpl& vpl : vpls) box.extend(vpl.position);
  std::vector<SortRecord> records(vpls.size());
  parallel_for(vpls.size(), k_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) records[i] = {morton_code(vpls[i].position, box), i};
  });
  radix_sort(records);
  std::vector<Vpl> sorted(vpls.size());
  parallel_for(vpls.size(), k_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sorted[i] = vpls[records[i].value];
  });
  return sorted;
}

/// Children are `first_child` and what follows it.
void fill_node(LightTree& tree, NodeIndex index, std::span<const LightCluster> children, std::uint32_t first_child) {
  LightNode& node = tree.nodes[index];
  int lane = 0;
  for (const LightCluster& child : children) {
    set_lane(node, tree.gloss.empty() ? nullptr : &tree.gloss[index], lane, child,
             first_child + static_cast<std::uint32_t>(lane));
    ++lane;
  }
  clear_lanes(node, lane);
}

}  // namespace

LightTree build_pairs(VplSet set) {
  LightTree tree;
  tree.set = std::move(set);
  if (tree.set.vpls.empty()) return tree;
  tree.set.vpls = in_morton_order(tree.set.vpls);

  // Eight neighbours make a node, level by level: pairs of pairs of pairs. The root is first in memory, each level
  // after the one above it.
  constexpr std::size_t k_width = LightNode::k_width;
  std::vector<std::size_t> level_sizes;  // from the leaves up
  for (std::size_t size = tree.set.vpls.size(); level_sizes.empty() || size > 1; level_sizes.push_back(size))
    size = (size + k_width - 1) / k_width;
  const std::size_t total = std::accumulate(level_sizes.begin(), level_sizes.end(), std::size_t{0});
  tree.nodes.resize(total);
  if (!tree.set.surfaces.empty()) tree.gloss.resize(total);
  std::vector<LightCluster> below;
  std::size_t first = total, first_below = 0;
  for (const std::size_t size : level_sizes) {
    first -= size;
    const bool leaves = below.empty();
    const std::size_t children = leaves ? tree.set.vpls.size() : below.size();
    std::vector<LightCluster> level(size);
    parallel_for(size, k_grain, [&](std::size_t begin, std::size_t end) {
      std::array<LightCluster, k_width> clusters;
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t first_child = i * k_width, count = std::min(k_width, children - first_child);
        for (std::size_t k = 0; k < count; ++k)
          clusters[k] = leaves ? make_cluster(tree.set, tree.set.vpls[first_child + k]) : below[first_child + k];
        const auto reference = static_cast<std::uint32_t>(first_child + (leaves ? 0 : first_below));
        fill_node(tree, static_cast<NodeIndex>(first + i), std::span(clusters).first(count),
                  leaves ? reference | LightNode::k_leaf : reference);
        level[i] = merge_clusters(std::span(clusters).first(count));
      }
    });
    below = std::move(level);
    first_below = first;
  }
  return tree;
}

}  // namespace gradslc
