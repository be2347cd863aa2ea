#pragma once

#include "reconstruction/reconstruction.h"
#include "reconstruction/screened_poisson.h"

namespace gradslc {

/// Weight of the primal's values against those of the gradients where nothing is known of their variances: the value of
/// Lehtinen et al. 2013, "Gradient-domain Metropolis light transport".
constexpr double k_default_alpha = 0.2;

/// Counts of the three terms relative to the image's largest count, the primal's times alpha^2. Constant counts give
/// uniform weights.
PoissonWeights count_weights(const ReconstructionBuffers& buffers, double alpha);

struct VarianceWeightOptions {
  double lambda = 0.5;    ///< weight of the primal against the gradients
  int primal_radius = 3;  ///< variances are means over (2 radius + 1)^2 pixels; 0: not smoothed
  int gradient_radius = 1;
};

/// Inverse variances of the means in `weighted`, from the variances in `source` (the same buffers, or another half's):
///   w = count / (v + floor), the primal's times lambda, up to a common factor,
/// v: variance of one sample, that is `source`'s variance of the mean times its count, averaged over channels and over
/// the box's pixels where it is known; where it is known for none, its mean over the image, so that the count decides.
/// floor: 1e-3 of the term's mean v, and no less than 1e-6 of the largest mean of the three terms.
/// Where a term's variance is known nowhere (fewer than two sets of samples), or no term has any variance, the weights
/// are count_weights(weighted, k_default_alpha).
PoissonWeights variance_weights(const ReconstructionBuffers& weighted, const ReconstructionBuffers& source,
                                const VarianceWeightOptions& options);

}  // namespace gradslc
