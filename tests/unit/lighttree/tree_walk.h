#pragma once
// What lies below a cluster, and with which probability descent finds it: by walking the tree.

#include <functional>
#include <utility>
#include <vector>

#include "lighttree/bounds.h"

namespace gradslc {

/// One child of a node.
struct Child {
  NodeIndex node;
  int lane;
};

/// Calls visit(child) for every child at or below some lanes of a node.
inline void for_each_child(const LightTree& tree, NodeIndex start, LaneMask lanes,
                           const std::function<void(Child)>& visit) {
  std::vector<std::pair<NodeIndex, LaneMask>> stack{{start, lanes}};
  while (!stack.empty()) {
    const auto [node, mask] = stack.back();
    stack.pop_back();
    for (int lane = 0; lane < LightNode::k_width; ++lane) {
      if ((mask >> lane & 1) == 0 || !tree.nodes[node].has_child(lane)) continue;
      visit({node, lane});
      if (!tree.nodes[node].is_leaf(lane)) stack.emplace_back(tree.nodes[node].child[lane], k_all_lanes);
    }
  }
}

inline std::vector<std::uint32_t> vpls_below(const LightTree& tree, NodeIndex start, LaneMask lanes = k_all_lanes) {
  std::vector<std::uint32_t> vpls;
  for_each_child(tree, start, lanes, [&](Child child) {
    if (tree.nodes[child.node].is_leaf(child.lane)) vpls.push_back(tree.nodes[child.node].vpl(child.lane));
  });
  return vpls;
}
inline std::vector<std::uint32_t> vpls_below(const LightTree& tree, Child child) {
  return vpls_below(tree, child.node, LaneMask{1} << child.lane);
}

/// The probability with which descent from some lanes of a node ends at each VPL of the tree: all branches walked with
/// the one probability function.
inline std::vector<double> descent_law(const LightTree& tree, NodeIndex start, LaneMask lanes,
                                       std::span<const Receiver> receivers, float bound) {
  std::vector<double> law(tree.set.vpls.size(), 0);
  const std::function<void(NodeIndex, LaneMask, double)> walk = [&](NodeIndex node, LaneMask mask, double p) {
    ChildWeights weights;
    evaluate_children(tree, node, receivers, bound, weights);
    const ChildProbabilities probabilities = child_probabilities(weights, mask);
    for (int lane = 0; lane < LightNode::k_width; ++lane) {
      if ((mask >> lane & 1) == 0 || !tree.nodes[node].has_child(lane)) continue;
      if (tree.nodes[node].is_leaf(lane))
        law[tree.nodes[node].vpl(lane)] = p * probabilities.lane[lane];
      else
        walk(tree.nodes[node].child[lane], k_all_lanes, p * probabilities.lane[lane]);
    }
  };
  walk(start, lanes, 1);
  return law;
}

}  // namespace gradslc
