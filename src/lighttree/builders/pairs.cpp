#include "lighttree/builders/pairs.h"

#include <algorithm>
#include <cstddef>

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

}  // namespace

LightTree build_pairs(VplSet set) {
  LightTree tree;
  tree.set = std::move(set);
  if (tree.set.vpls.empty()) return tree;
  tree.set.vpls = in_morton_order(tree.set.vpls);

  // Levels from the root down: sizes n, ceil(n/2), ..., 1 from the leaves up, the root first in memory. A node without
  // a sibling is kept once, at its lowest level, and referred to from above.
  const std::size_t leaves = tree.set.vpls.size();
  const std::size_t total = 2 * leaves - 1;
  tree.nodes.resize(total);
  std::size_t level_end = total;  // nodes of the level being made fill [level_end - size, level_end)
  std::vector<NodeIndex> level(leaves);
  parallel_for(leaves, k_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      level[i] = static_cast<NodeIndex>(total - leaves + i);
      tree.nodes[level[i]] = make_leaf(tree.set, static_cast<std::uint32_t>(i));
    }
  });
  level_end -= leaves;
  while (level.size() > 1) {
    const std::size_t pairs = level.size() / 2;
    std::vector<NodeIndex> above((level.size() + 1) / 2);
    const std::size_t first = level_end - pairs;
    parallel_for(pairs, k_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const NodeIndex left = level[2 * i], right = level[2 * i + 1];
        above[i] = static_cast<NodeIndex>(first + i);
        tree.nodes[above[i]] = merge_nodes(tree.nodes[left], tree.nodes[right], left, right);
      }
    });
    if (level.size() % 2 == 1) above.back() = level.back();
    level_end = first;
    level = std::move(above);
  }
  return tree;
}

}  // namespace gradslc
