#include "lighttree/descent.h"

#include <algorithm>

namespace gradslc {

std::optional<DescentSample> descend(const LightTree& tree, NodeIndex start, std::span<const Receiver> receivers,
                                     float bound, double u, std::uint64_t& node_evaluations) {
  constexpr double k_below_one = 1 - 0x1p-53;
  NodeIndex node = start;
  double probability = 1;
  while (!tree.nodes[node].is_leaf()) {
    node_evaluations += 2 * receivers.size();
    const auto p_left = left_probability(tree, node, receivers, bound);
    if (!p_left) return std::nullopt;
    if (u < *p_left) {
      probability *= *p_left;
      u = std::min(u / *p_left, k_below_one);
      node = tree.nodes[node].left;
    } else {
      const double p_right = 1 - *p_left;
      probability *= p_right;
      u = std::clamp((u - *p_left) / p_right, 0.0, k_below_one);
      node = tree.nodes[node].right;
    }
  }
  return DescentSample{tree.nodes[node].left, probability};
}

}  // namespace gradslc
