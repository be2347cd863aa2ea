#include "lighttree/comb.h"

#include <cmath>

namespace gradslc {
namespace {

/// A subtree's share of the unit interval, and the comb's points in it.
struct Share {
  NodeIndex node;
  std::uint32_t first_point, end_point;
  double low, width;
};

}  // namespace

std::uint64_t draw_candidates(const LightTree& tree, const TileLaw& law, int size, double u,
                              std::vector<Candidate>& candidates) {
  candidates.clear();
  if (tree.empty()) return 0;
  std::uint64_t weighed = 0;
  const double points = size;
  std::vector<Share> stack{{0, 0, static_cast<std::uint32_t>(size), 0, 1}};
  while (!stack.empty()) {
    const Share share = stack.back();
    stack.pop_back();
    const LightNode& node = tree.nodes[share.node];
    alignas(32) LightNode::Lanes weights;
    law.weigh(tree, share.node, weights);
    ++weighed;
    double total = 0;
    for (const float weight : weights) total += static_cast<double>(weight);
    if (!(total > 0)) continue;
    const double per_total = 1 / total;

    // Point k lies at (k + u) / size. Children share their borders, so that each point falls to one of them.
    const std::size_t first_pushed = stack.size();
    double below = 0;
    std::uint32_t first_point = share.first_point;
    for (int lane = 0; lane < LightNode::k_width; ++lane) {
      if (weights[lane] == 0) continue;
      const double probability = static_cast<double>(weights[lane]) * per_total;
      const double low = share.low + share.width * (below * per_total);
      below += static_cast<double>(weights[lane]);
      const double high = share.low + share.width * (below * per_total);
      const double border = std::ceil(high * points - u);
      const std::uint32_t end_point =
          below == total ? share.end_point
                         : std::clamp(static_cast<std::uint32_t>(std::max(border, 0.0)), first_point, share.end_point);
      if (end_point > first_point) {
        if (node.is_leaf(lane))
          candidates.push_back({node.vpl(lane), end_point - first_point, share.width * probability});
        else
          stack.push_back({node.child[lane], first_point, end_point, low, share.width * probability});
      }
      first_point = end_point;
    }
    std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first_pushed), stack.end());
  }
  return weighed;
}

}  // namespace gradslc
