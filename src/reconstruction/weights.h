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
  double lambda = 1;  ///< weight of the primal against the gradients
  int radius = 1;     ///< of the box of (2 radius + 1)^2 pixels whose mean supports a pixel's variance; 0: none
};

/// Inverse variances of the means in `weighted`, from the variances in `source` (the same buffers, or another half's):
///   w = count / (v + floor), the primal's times lambda, up to a common factor,
/// v: variance of one sample, that is `source`'s variance of the mean times its count, averaged over channels; but no
/// less than half the mean over the box's pixels where it is known, so that one that few samples make too small by
/// chance gets no great weight, while edges, where gradients are noisy, stay one pixel wide. Where it is unknown, the
/// box's mean; where that is, too, the mean over the image, so that the count decides.
/// floor: 1e-3 of the term's mean v, and no less than 1e-6 of the largest mean of the three terms.
/// Where a term's variance is known nowhere (fewer than two sets of samples), or no term has any variance, the weights
/// are count_weights(weighted, k_default_alpha).
PoissonWeights variance_weights(const ReconstructionBuffers& weighted, const ReconstructionBuffers& source,
                                const VarianceWeightOptions& options);

/// The screened Poisson problem of `weighted` with variance_weights(weighted, source), solved.
ReconstructionResult solve_weighted(const ReconstructionBuffers& weighted, const ReconstructionBuffers& source,
                                    const VarianceWeightOptions& options, const SolverOptions& solver);

/// Two images of independent halves as one: by counts; the plain mean where neither has samples. Statistics of both.
ReconstructionResult average_by_counts(const ReconstructionResult& a, const Image<float>& a_count,
                                       const ReconstructionResult& b, const Image<float>& b_count);

}  // namespace gradslc
