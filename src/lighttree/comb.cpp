#include "lighttree/comb.h"

#include <cmath>

namespace gradslc {
namespace {

/// A subtree's share of the unit interval, and the comb's points in it.
struct Share {
  NodeIndex node;
  std::uint32_t first_point, end_point;
  double low;
  double by_law, by_power;  ///< probabilities of reaching the subtree by either alone
};

}  // namespace

std::uint64_t draw_candidates(const LightTree& tree, const TileLaw& law, int size, double u,
                              std::vector<Candidate>& candidates) {
  candidates.clear();
  if (tree.empty()) return 0;
  std::uint64_t weighed = 0;
  const double points = size;
  const double power_share = static_cast<double>(law.settings().power_share);
  std::vector<Share> stack{{0, 0, static_cast<std::uint32_t>(size), 0, 1, 1}};
  while (!stack.empty()) {
    const Share share = stack.back();
    stack.pop_back();
    const LightNode& node = tree.nodes[share.node];
    alignas(32) LightNode::Lanes weights;
    law.weigh(tree, share.node, weights);
    ++weighed;
    double all_weights = 0, all_power = 0;  // of the children that light anything
    int last = -1;
    for (int lane = 0; lane < LightNode::k_width; ++lane) {
      if (weights[lane] == 0) continue;
      all_weights += static_cast<double>(weights[lane]), all_power += static_cast<double>(node.capped_flux[lane]);
      last = lane;
    }
    if (last < 0) continue;

    // Point k lies at (k + u) / size. Children share their borders, so that each point falls to one of them.
    const std::size_t first_pushed = stack.size();
    double low = share.low;
    std::uint32_t first_point = share.first_point;
    for (int lane = 0; lane <= last; ++lane) {
      if (weights[lane] == 0) continue;
      const double by_law = share.by_law * (static_cast<double>(weights[lane]) / all_weights);
      const double by_power =
          all_power > 0 ? share.by_power * (static_cast<double>(node.capped_flux[lane]) / all_power) : by_law;
      const double probability = (1 - power_share) * by_law + power_share * by_power;
      const double high = low + probability;
      const double border = std::ceil(high * points - u);
      const std::uint32_t end_point =
          lane == last ? share.end_point
                       : std::clamp(static_cast<std::uint32_t>(std::max(border, 0.0)), first_point, share.end_point);
      if (end_point > first_point) {
        if (node.is_leaf(lane))
          candidates.push_back({node.vpl(lane), end_point - first_point, probability});
        else
          stack.push_back({node.child[lane], first_point, end_point, low, by_law, by_power});
      }
      first_point = end_point, low = high;
    }
    std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first_pushed), stack.end());
  }
  return weighed;
}

}  // namespace gradslc
