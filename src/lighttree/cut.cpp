#include "lighttree/cut.h"

#include <algorithm>
#include <cassert>

namespace gradslc {
namespace {

/// Heap order: inner nodes by bound, leaves (which cannot be split) last; ties by index, so that the cut is one.
bool splits_later(const LightTree& tree, const LightCut::Entry& a, const LightCut::Entry& b) {
  const bool a_leaf = tree.nodes[a.node].is_leaf(), b_leaf = tree.nodes[b.node].is_leaf();
  if (a_leaf != b_leaf) return a_leaf;
  if (a.bound != b.bound) return a.bound < b.bound;
  return a.node > b.node;
}

}  // namespace

void find_cut(const LightTree& tree, std::span<const Receiver> receivers, float bound, int cut_size, LightCut& cut) {
  assert(cut_size >= 1);
  std::vector<LightCut::Entry>& heap = cut.entries;
  heap.clear();
  if (tree.empty()) return;
  const auto later = [&](const LightCut::Entry& a, const LightCut::Entry& b) { return splits_later(tree, a, b); };
  const auto push = [&](NodeIndex node) {
    ++cut.node_evaluations;
    const float node_bound = cluster_bound(tree.nodes[node], receivers, bound);
    if (!(node_bound > 0)) return;
    heap.push_back({node, node_bound});
    std::push_heap(heap.begin(), heap.end(), later);
  };
  push(0);
  while (!heap.empty() && heap.size() < static_cast<std::size_t>(cut_size)) {
    const NodeIndex widest = heap.front().node;
    if (tree.nodes[widest].is_leaf()) break;
    std::pop_heap(heap.begin(), heap.end(), later);
    heap.pop_back();
    push(tree.nodes[widest].left);
    push(tree.nodes[widest].right);
  }
}

}  // namespace gradslc
