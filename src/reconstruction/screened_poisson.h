#pragma once

#include "core/image.h"
#include "reconstruction/reconstruction.h"

namespace gradslc {

/// Weights of the three terms, per pixel, shared by the channels; >= 0 and finite. They matter up to a common factor.
/// dx's last column and dy's last row are not used.
struct PoissonWeights {
  Image<float> primal, dx, dy;
};

/// Find I that minimises, per channel,
///   sum w_p |I - P|^2 + w_x |I(x+1,y) - I(x,y) - X|^2 + w_y |I(x,y+1) - I(x,y) - Y|^2
/// (Bhat et al. 2008, "Fourier analysis of the 2D screened Poisson equation for gradient domain problems", with a
/// weight per pixel). All images have the same size; values are finite, also where they have no weight.
struct ScreenedPoissonProblem {
  const RgbImage &primal, &dx, &dy;
  const PoissonWeights& weights;
  const RgbImage* start = nullptr;  ///< an image near the solution; nullptr: the primal
};

struct SolverOptions {
  double relative_residual = 1e-5;  ///< |b - A I| / |b| (Euclidean, per channel) at which to stop
  int max_iterations = 20000;       ///< per channel
  bool preconditioned = true;       ///< false: plain conjugate gradients, to compare with
};

/// Solves A I = b, the normal equations, to the residual that is asked for or as far as iterations allow. Statistics:
/// the most iterations of a channel, and the true residual of the solution before it is rounded to float.
/// Where pixels are joined by gradients but none has a primal weight, the image follows the gradients up to a constant
/// that is arbitrary, but finite; a pixel without any weight is 0.
ReconstructionResult solve(const ScreenedPoissonProblem& problem, const SolverOptions& options);

}  // namespace gradslc
