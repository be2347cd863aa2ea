#include "lighttree/cut.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace gradslc {
namespace {

/// The first half of the lanes, the larger one where they are odd.
LaneMask lower_half(LaneMask lanes) {
  const int first = std::countr_zero(lanes), count = std::popcount(lanes);
  const LaneMask half = (LaneMask{1} << (count + 1) / 2) - 1;
  return half << first;
}

class Refinement {
 public:
  Refinement(const LightTree& tree, std::span<const Receiver> receivers, float bound, LightCut& cut)
      : splitter_(tree, receivers, bound, cut.evaluated), entries_(cut.entries) {
    cut.entries.clear(), cut.evaluated.clear();
    push(splitter_.root());
  }

  /// Whether nothing is left to refine, or no bound of what is left is above `error` of all.
  bool is_within(float error) const {
    if (entries_.empty() || is_single_vpl(splitter_.tree(), entries_.front())) return true;
    return static_cast<double>(entries_.front().bound) <= static_cast<double>(error) * finite_bounds_;
  }

  void refine_widest() {
    const CutEntry widest = entries_.front();
    std::pop_heap(entries_.begin(), entries_.end(), splits_later());
    entries_.pop_back();
    if (std::isfinite(widest.bound)) finite_bounds_ -= static_cast<double>(widest.bound);
    push(splitter_.split(widest));
  }

 private:
  /// Heap order: by bound, VPLs (which cannot be split) last; ties by index, so that the cut is one.
  struct SplitsLater {
    const LightTree& tree;
    bool operator()(const CutEntry& a, const CutEntry& b) const {
      const bool a_vpl = is_single_vpl(tree, a), b_vpl = is_single_vpl(tree, b);
      if (a_vpl != b_vpl) return a_vpl;
      if (a.bound != b.bound) return a.bound < b.bound;
      return a.node != b.node ? a.node > b.node : a.lanes > b.lanes;
    }
  };
  SplitsLater splits_later() const { return {splitter_.tree()}; }

  void push(const CutParts& parts) {
    for (const CutEntry& part : parts) {
      if (std::isfinite(part.bound)) finite_bounds_ += static_cast<double>(part.bound);
      entries_.push_back(part);
      std::push_heap(entries_.begin(), entries_.end(), splits_later());
    }
  }

  ClusterSplitter splitter_;
  std::vector<CutEntry>& entries_;
  double finite_bounds_ = 0;
};

}  // namespace

bool is_single_vpl(const LightTree& tree, const CutEntry& entry) {
  return std::has_single_bit(entry.lanes) && tree.nodes[entry.node].is_leaf(std::countr_zero(entry.lanes));
}

CutParts ClusterSplitter::root() {
  CutParts parts;
  if (!tree_.empty()) add_node(0, parts);
  return parts;
}

CutParts ClusterSplitter::split(const CutEntry& entry) {
  assert(!is_single_vpl(tree_, entry));
  CutParts parts;
  if (std::has_single_bit(entry.lanes)) {
    add_node(tree_.nodes[entry.node].child[std::countr_zero(entry.lanes)], parts);
    return parts;
  }
  const LaneMask lower = lower_half(entry.lanes);
  add_lanes(entry.node, lower, entry.evaluated, parts);
  add_lanes(entry.node, entry.lanes & ~lower, entry.evaluated, parts);
  return parts;
}

void ClusterSplitter::add_node(NodeIndex node, CutParts& parts) {
  const auto evaluated = static_cast<std::uint32_t>(evaluated_.size());
  evaluate_children(tree_, node, receivers_, bound_, evaluated_.emplace_back());
  LaneMask lanes = 0;
  for (int lane = 0; lane < LightNode::k_width; ++lane)
    if (tree_.nodes[node].has_child(lane)) lanes |= LaneMask{1} << lane;
  add_lanes(node, lanes, evaluated, parts);
}

void ClusterSplitter::add_lanes(NodeIndex node, LaneMask lanes, std::uint32_t evaluated, CutParts& parts) const {
  CutEntry entry{node, lanes, evaluated, 0};
  for (int lane = 0; lane < LightNode::k_width; ++lane)
    if ((lanes >> lane & 1) != 0) entry.bound += evaluated_[evaluated].bound[lane];
  if (entry.bound > 0) parts.parts[parts.count++] = entry;
}

void find_cut(const LightTree& tree, std::span<const Receiver> receivers, float bound, const CutLimits& limits,
              LightCut& cut) {
  assert(limits.size >= 1);
  Refinement refinement(tree, receivers, bound, cut);
  while (cut.entries.size() < static_cast<std::size_t>(limits.size) && !refinement.is_within(limits.error))
    refinement.refine_widest();
}

}  // namespace gradslc
