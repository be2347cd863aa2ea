#include "lighttree/cut.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace gradslc {
namespace {

bool is_vpl(const LightTree& tree, const CutEntry& entry) {
  return std::has_single_bit(entry.lanes) && tree.nodes[entry.node].is_leaf(std::countr_zero(entry.lanes));
}

class Refinement {
 public:
  Refinement(const LightTree& tree, std::span<const Receiver> receivers, float bound, LightCut& cut)
      : tree_(tree), receivers_(receivers), bound_(bound), cut_(cut) {
    cut_.entries.clear(), cut_.evaluated.clear();
    if (!tree_.empty()) push_node(0);
  }

  /// False: nothing is left to refine.
  bool refine_widest() {
    if (cut_.entries.empty() || is_vpl(tree_, cut_.entries.front())) return false;
    const CutEntry widest = cut_.entries.front();
    std::pop_heap(cut_.entries.begin(), cut_.entries.end(), splits_later());
    cut_.entries.pop_back();
    if (std::has_single_bit(widest.lanes)) {
      push_node(tree_.nodes[widest.node].child[std::countr_zero(widest.lanes)]);
      return true;
    }
    const LaneMask lower = lower_half(widest.lanes);
    push({widest.node, lower, widest.evaluated, 0});
    push({widest.node, widest.lanes & ~lower, widest.evaluated, 0});
    return true;
  }

 private:
  /// Heap order: by bound, VPLs (which cannot be split) last; ties by index, so that the cut is one.
  struct SplitsLater {
    const LightTree& tree;
    bool operator()(const CutEntry& a, const CutEntry& b) const {
      const bool a_vpl = is_vpl(tree, a), b_vpl = is_vpl(tree, b);
      if (a_vpl != b_vpl) return a_vpl;
      if (a.bound != b.bound) return a.bound < b.bound;
      return a.node != b.node ? a.node > b.node : a.lanes > b.lanes;
    }
  };
  SplitsLater splits_later() const { return {tree_}; }

  /// The first half of the lanes, the larger one where they are odd.
  static LaneMask lower_half(LaneMask lanes) {
    const int first = std::countr_zero(lanes), count = std::popcount(lanes);
    const LaneMask half = (LaneMask{1} << (count + 1) / 2) - 1;
    return half << first;
  }

  void push_node(NodeIndex node) {
    const auto evaluated = static_cast<std::uint32_t>(cut_.evaluated.size());
    evaluate_children(tree_, node, receivers_, bound_, cut_.evaluated.emplace_back());
    LaneMask lanes = 0;
    for (int lane = 0; lane < LightNode::k_width; ++lane)
      if (tree_.nodes[node].has_child(lane)) lanes |= LaneMask{1} << lane;
    push({node, lanes, evaluated, 0});
  }

  void push(CutEntry entry) {
    const ChildWeights& weights = cut_.evaluated[entry.evaluated];
    for (int lane = 0; lane < LightNode::k_width; ++lane)
      if ((entry.lanes >> lane & 1) != 0) entry.bound += weights.bound[lane];
    if (!(entry.bound > 0)) return;
    cut_.entries.push_back(entry);
    std::push_heap(cut_.entries.begin(), cut_.entries.end(), splits_later());
  }

  const LightTree& tree_;
  std::span<const Receiver> receivers_;
  float bound_;
  LightCut& cut_;
};

}  // namespace

void find_cut(const LightTree& tree, std::span<const Receiver> receivers, float bound, int cut_size, LightCut& cut) {
  assert(cut_size >= 1);
  Refinement refinement(tree, receivers, bound, cut);
  while (cut.entries.size() < static_cast<std::size_t>(cut_size) && refinement.refine_widest()) {
  }
}

}  // namespace gradslc
