#include "lighttree/estimated_cut.h"

#include <algorithm>
#include <cassert>

namespace gradslc {
namespace {

/// Heap order; ties by index, so that the cut is one.
bool splits_later(const EstimatedCluster& a, const EstimatedCluster& b) {
  if (a.error != b.error) return a.error < b.error;
  return a.entry.node != b.entry.node ? a.entry.node > b.entry.node : a.entry.lanes > b.entry.lanes;
}

class Refinement {
 public:
  Refinement(const Representatives& representatives, const Contribution& contribution, ClusterSplitter splitter,
             EstimatedCut& cut)
      : representatives_(representatives), contribution_(contribution), splitter_(splitter), cut_(cut) {
    cut_.clusters.clear(), cut_.evaluated.clear(), cut_.representatives = 0;
    for (const CutEntry& part : splitter_.root()) push(part, nullptr);
  }

  bool is_within(float error_ratio) const {
    if (cut_.clusters.empty() || cut_.clusters.front().error == 0) return true;
    return static_cast<double>(cut_.clusters.front().error) <= static_cast<double>(error_ratio) * total_;
  }

  void refine_widest() {
    const EstimatedCluster widest = cut_.clusters.front();
    std::pop_heap(cut_.clusters.begin(), cut_.clusters.end(), splits_later);
    cut_.clusters.pop_back();
    total_ -= static_cast<double>(luminance(widest.estimate));
    for (const CutEntry& part : splitter_.split(widest.entry)) push(part, &widest);
  }

 private:
  void push(const CutEntry& entry, const EstimatedCluster* parent) {
    EstimatedCluster cluster{entry, representatives_.of(entry.node, entry.lanes), Rgb(), Rgb(), 0};
    const auto [vpl, flux] = cluster.representative;
    if (parent && parent->representative.vpl == vpl) {
      cluster.contribution = parent->contribution;
    } else {
      cluster.contribution = contribution_(vpl);
      ++cut_.representatives;
    }
    // The bound is > 0, so some VPL of the cluster has flux, and so does its representative.
    cluster.estimate = cluster.contribution * (flux / luminance(splitter_.tree().set.vpls[vpl].flux));
    total_ += static_cast<double>(luminance(cluster.estimate));
    if (!is_single_vpl(splitter_.tree(), entry)) cluster.error = entry.bound * (k_inv_pi * k_inv_pi);
    cut_.clusters.push_back(cluster);
    std::push_heap(cut_.clusters.begin(), cut_.clusters.end(), splits_later);
  }

  const Representatives& representatives_;
  const Contribution& contribution_;
  ClusterSplitter splitter_;
  EstimatedCut& cut_;
  double total_ = 0;  ///< luminance of all estimates
};

}  // namespace

Rgb EstimatedCut::total() const {
  return total([](std::uint32_t) { return true; });
}

Rgb EstimatedCut::total(const std::function<bool(std::uint32_t vpl)>& selects) const {
  double sum[3] = {};
  for (const EstimatedCluster& cluster : clusters) {
    if (!selects(cluster.representative.vpl)) continue;
    for (int channel = 0; channel < 3; ++channel) sum[channel] += static_cast<double>(cluster.estimate[channel]);
  }
  return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

void find_estimated_cut(const LightTree& tree, const Representatives& representatives, const Receiver& receiver,
                        float bound, const ErrorLimits& limits, const Contribution& contribution, EstimatedCut& cut) {
  assert(limits.most_clusters >= 1);
  Refinement refinement(representatives, contribution, ClusterSplitter(tree, {&receiver, 1}, bound, cut.evaluated),
                        cut);
  while (cut.clusters.size() < static_cast<std::size_t>(limits.most_clusters) &&
         !refinement.is_within(limits.error_ratio))
    refinement.refine_widest();
}

}  // namespace gradslc
