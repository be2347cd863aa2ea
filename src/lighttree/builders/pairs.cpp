#include "lighttree/builders/pairs.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "lighttree/builders/morton_order.h"
#include "lighttree/fill_node.h"

namespace gradslc {
namespace {

constexpr std::size_t k_width = LightNode::k_width, k_grain = 4096;

/// Nodes of each level, from the leaves' up to the root.
std::vector<std::size_t> level_sizes(std::size_t vpls) {
  std::vector<std::size_t> sizes;
  for (std::size_t size = vpls; sizes.empty() || size > 1; sizes.push_back(size)) size = (size + k_width - 1) / k_width;
  return sizes;
}

}  // namespace

double pairs_bytes(const VplCounts& counts) {
  return counts.bytes() + counts.vpls / (k_width - 1) * node_bytes(counts);  // n/8 + n/64 + ... = n/7 nodes
}

double pairs_peak_bytes(const VplCounts& counts) {
  return pairs_bytes(counts);  // the sort borrows the nodes' memory
}

LightTree build_pairs(VplSet set) {
  LightTree tree;
  tree.set = std::move(set);
  const std::size_t vpls = tree.set.vpls.size();
  if (vpls == 0) return tree;
  // Eight neighbours make a node, level by level: pairs of pairs of pairs. The root is first in memory, each level
  // after the one above it.
  const std::vector<std::size_t> sizes = level_sizes(vpls);
  std::size_t first = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  // The nodes' memory serves the sort before they are filled. They are 64 bytes a VPL, up to rounding.
  resize_nodes(tree, std::max(first, (vpls * k_morton_bytes + sizeof(LightNode) - 1) / sizeof(LightNode)));
  sort_in_morton_order(tree.set.vpls, std::as_writable_bytes(std::span(tree.nodes)));
  resize_nodes(tree, first);
  first -= sizes.front();
  parallel_for(sizes.front(), k_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      fill_leaf_node(tree, static_cast<NodeIndex>(first + i), static_cast<std::uint32_t>(i * k_width),
                     static_cast<int>(std::min(k_width, vpls - i * k_width)));
  });
  for (std::size_t level = 1; level < sizes.size(); ++level) {
    const std::size_t below = first;
    first -= sizes[level];
    parallel_for(sizes[level], k_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        NodeIndex children[k_width];
        std::iota(std::begin(children), std::end(children), static_cast<NodeIndex>(below + i * k_width));
        fill_inner_node(tree, static_cast<NodeIndex>(first + i),
                        std::span(children).first(std::min(k_width, sizes[level - 1] - i * k_width)));
      }
    });
  }
  return tree;
}

}  // namespace gradslc
