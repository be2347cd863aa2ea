#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "reconstruction/buffers.h"
#include "reconstruction/methods.h"
#include "reconstruction/weights.h"

namespace gradslc {
namespace {

/// Norms over the channels of what a solution lacks of each term, times the roots of the terms' weights.
struct Deviations {
  Image<float> primal, dx, dy;
  double mean = 0;  ///< of all, also of those without weight, which are 0
};

/// Sum of weighted absolute deviations (Lehtinen et al. 2013, section 4; Kettunen et al. 2015): an outlier counts by
/// its distance and not by its square. Solved by iteratively reweighted least squares (Daubechies et al. 2010): weights
/// over deviations, of which the smallest are taken for a small share of their mean that halves with every solution.
/// Biased: a median is not a mean.
class L1 final : public Reconstruction {
 public:
  void describe(ParameterVisitor& visitor) override {
    visitor.real("alpha", alpha_, {1e-3, 100}, "", "weight of the primal against the gradients");
    visitor.integer("reweightings", reweightings_, {1, 100}, "solutions", "linear systems that are solved in turn");
    visitor.real("relative_residual", solver_.relative_residual, {1e-10, 0.1}, "",
                 "residual of the last linear system, relative to its right-hand side, at which its solver stops");
  }

  ReconstructionResult reconstruct(const ReconstructionInput& input) const override {
    const ReconstructionBuffers& buffers = input.combined;
    check_primal_and_gradients(buffers);
    const PoissonWeights squares = count_weights(buffers, alpha_);
    SolverOptions rough = solver_;
    rough.relative_residual = std::max(solver_.relative_residual, 1e-3);
    ReconstructionResult result = solve({buffers.primal, buffers.dx, buffers.dy, squares}, rough);
    double smallest = 0.5;
    for (int i = 0; i < reweightings_; ++i, smallest /= 2) {
      const Deviations deviations = deviations_of(result.image, buffers, squares);
      if (deviations.mean == 0) break;
      const PoissonWeights weights = reweighted(squares, deviations, std::max(smallest, 1e-3) * deviations.mean);
      const bool last = i + 1 == reweightings_;
      const ScreenedPoissonProblem problem{buffers.primal, buffers.dx, buffers.dy, weights, &result.image};
      ReconstructionResult next = solve(problem, last ? solver_ : rough);
      next.statistics.iterations += result.statistics.iterations;
      result = std::move(next);
    }
    return result;
  }

 private:
  static Deviations deviations_of(const RgbImage& image, const ReconstructionBuffers& buffers,
                                  const PoissonWeights& weights) {
    const Resolution resolution = image.resolution();
    const int width = resolution.width, height = resolution.height;
    Deviations found{Image<float>(resolution), Image<float>(resolution), Image<float>(resolution)};
    const double sum = parallel_sum<double>(static_cast<std::size_t>(height), 16, [&](auto begin, auto end) {
      double rows = 0;
      const auto set = [&](Image<float>& deviation, const Image<float>& weight, int x, int y, Rgb lack) {
        const float square = lack.r * lack.r + lack.g * lack.g + lack.b * lack.b;
        rows += static_cast<double>(deviation(x, y) = std::sqrt(weight(x, y) * square));
      };
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
        for (int x = 0; x < width; ++x) {
          const Rgb here = image(x, y);
          set(found.primal, weights.primal, x, y, buffers.primal(x, y) - here);
          if (x + 1 < width) set(found.dx, weights.dx, x, y, buffers.dx(x, y) - (image(x + 1, y) - here));
          if (y + 1 < height) set(found.dy, weights.dy, x, y, buffers.dy(x, y) - (image(x, y + 1) - here));
        }
      return rows;
    });
    found.mean = sum / (3 * static_cast<double>(resolution.pixels()));
    return found;
  }

  static PoissonWeights reweighted(const PoissonWeights& squares, const Deviations& deviations, double smallest) {
    const auto of_term = [&](const Image<float>& square, const Image<float>& deviation) {
      Image<float> weights(square.resolution());
      for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = static_cast<float>(static_cast<double>(square[i]) * smallest /
                                        std::max(static_cast<double>(deviation[i]), smallest));
      return weights;
    };
    return {of_term(squares.primal, deviations.primal), of_term(squares.dx, deviations.dx),
            of_term(squares.dy, deviations.dy)};
  }

  double alpha_ = k_default_alpha;
  int reweightings_ = 8;
  SolverOptions solver_;
};

}  // namespace

std::unique_ptr<Reconstruction> make_l1() { return std::make_unique<L1>(); }

}  // namespace gradslc
