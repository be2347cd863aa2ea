#pragma once

#include <functional>
#include <vector>

#include "lighttree/cut.h"
#include "lighttree/representatives.h"

namespace gradslc {

/// A cluster with what its representative says of it.
struct EstimatedCluster {
  CutEntry entry;
  Representatives::Representative representative;
  Rgb contribution;  ///< the representative's alone
  Rgb estimate;      ///< of the cluster: the same, scaled by the cluster's flux over the representative's
  float error;       ///< the bound of what its VPLs bring, luminance; 0: a VPL by itself, exact
};

/// Lightcuts' cut (Walter et al. 2005) for one receiver. Keeps its memory between uses.
struct EstimatedCut {
  std::vector<EstimatedCluster> clusters;
  std::vector<ChildWeights> evaluated;
  std::uint64_t representatives = 0;  ///< how many were asked for their contribution

  Rgb total() const;
  /// Of the clusters whose representatives are selected.
  Rgb total(const std::function<bool(std::uint32_t vpl)>& selects) const;
};

/// When lightcuts' cut is fine enough.
struct ErrorLimits {
  float error_ratio = 0.02f;  ///< >= 0; enough once no cluster's error is above this share of the total estimate
  int most_clusters = 1000;   ///< >= 1
};

/// What a VPL brings to the receiver, its visibility included.
using Contribution = std::function<Rgb(std::uint32_t vpl)>;

/// Refines the cut from the root, largest error first, until a limit is reached. The part of a cluster that holds its
/// representative keeps that and what is known of it. A cluster's error is its bound (unshadowed), and nothing sampled:
/// where a representative says more than the bound, as one with gloss or another cap than the rest may, refining for
/// that would take back what is too much, leave what is too little, and darken.
void find_estimated_cut(const LightTree& tree, const Representatives& representatives, const Receiver& receiver,
                        float bound, const ErrorLimits& limits, const Contribution& contribution, EstimatedCut& cut);

}  // namespace gradslc
