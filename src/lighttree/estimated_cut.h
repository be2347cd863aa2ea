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
  Rgb per_flux;  ///< the representative's contribution if its flux were 1
  float error;   ///< bound of how far the luminance of estimate() may be off; 0: a VPL by itself, exact

  Rgb estimate() const { return per_flux * representative.flux; }
};

/// Lightcuts' cut (Walter et al. 2005) for one receiver. Keeps its memory between uses.
struct EstimatedCut {
  std::vector<EstimatedCluster> clusters;
  std::vector<ChildWeights> evaluated;
  std::uint64_t representatives = 0;  ///< how many were asked for their contribution

  Rgb total() const;
};

/// When lightcuts' cut is fine enough.
struct ErrorLimits {
  float error_ratio = 0.02f;  ///< >= 0; enough once no cluster's error is above this share of the total estimate
  int most_clusters = 1000;   ///< >= 1
};

/// What a VPL brings to the receiver, its visibility included, if its flux were 1 in every channel.
using ContributionPerFlux = std::function<Rgb(std::uint32_t vpl)>;

/// Refines the cut from the root, largest error first, until a limit is reached. The part of a cluster that holds its
/// representative keeps that and what is known of it. A cluster's error is its bound (unshadowed), or its estimate
/// where that is larger: a representative with gloss, or with another cap than the rest, may say more than the bound.
void find_estimated_cut(const LightTree& tree, const Representatives& representatives, const Receiver& receiver,
                        float bound, const ErrorLimits& limits, const ContributionPerFlux& contribution_per_flux,
                        EstimatedCut& cut);

}  // namespace gradslc
