#include "lighttree/descent.h"

#include <algorithm>

namespace gradslc {
namespace {

constexpr double k_below_one = 1 - 0x1p-53;

/// A lane by its probability; `u` becomes the position within it. -1: all are 0.
int choose_lane(const ChildProbabilities& probabilities, double& u) {
  double below = 0;
  int chosen = -1;
  for (int lane = 0; lane < LightNode::k_width; ++lane) {
    const double p = probabilities.lane[lane];
    if (p == 0) continue;
    chosen = lane;
    if (u < below + p) break;
    below += p;
  }
  if (chosen >= 0) u = std::clamp((u - below) / probabilities.lane[chosen], 0.0, k_below_one);
  return chosen;
}

}  // namespace

std::optional<DescentSample> descend(const LightTree& tree, const LightCut& cut, const CutEntry& entry,
                                     std::span<const Receiver> receivers, float bound, double u,
                                     std::uint64_t& node_evaluations) {
  ChildProbabilities probabilities = child_probabilities(cut.evaluated[entry.evaluated], entry.lanes);
  NodeIndex node = entry.node;
  double probability = 1;
  while (true) {
    const int lane = choose_lane(probabilities, u);
    if (lane < 0) return std::nullopt;
    probability *= probabilities.lane[lane];
    if (tree.nodes[node].is_leaf(lane)) return DescentSample{tree.nodes[node].vpl(lane), probability};
    node = tree.nodes[node].child[lane];
    ChildWeights weights;
    evaluate_children(tree, node, receivers, bound, weights);
    node_evaluations += receivers.size();
    probabilities = child_probabilities(weights, k_all_lanes);
  }
}

}  // namespace gradslc
