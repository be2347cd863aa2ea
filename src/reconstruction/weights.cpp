#include "reconstruction/weights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "reconstruction/box_sums.h"

namespace gradslc {
namespace {

constexpr double k_floor = 1e-3;         ///< of a term's mean variance
constexpr double k_lowest_floor = 1e-6;  ///< of the largest mean variance of the three terms

/// The pixels at which a term has values: dx has none in the last column, dy none in the last row.
struct Term {
  const RgbImage* variance;
  const Image<float>* count;
  Resolution used;
};
struct Terms {
  Term primal, dx, dy;
};
Terms terms_of(const ReconstructionBuffers& buffers) {
  const Resolution all = buffers.primal.resolution();
  return {{&buffers.primal_variance, &buffers.primal_count, all},
          {&buffers.dx_variance, &buffers.dx_count, {all.width - 1, all.height}},
          {&buffers.dy_variance, &buffers.dy_count, {all.width, all.height - 1}}};
}

float largest_count(const Term& term) {
  float largest = 0;
  for (int y = 0; y < term.used.height; ++y)
    for (int x = 0; x < term.used.width; ++x) largest = std::max(largest, (*term.count)(x, y));
  return largest;
}

/// Sum of what is known, and of how many values.
struct KnownSum {
  double sum = 0;
  double known = 0;
  KnownSum& operator+=(const KnownSum& other) {
    sum += other.sum;
    known += other.known;
    return *this;
  }
};

KnownSum sample_variance(const Term& term, int x, int y) {
  const Rgb variance = (*term.variance)(x, y);
  const float count = (*term.count)(x, y);
  if (!is_finite(variance) || count == 0) return {};
  const double mean =
      (static_cast<double>(variance.r) + static_cast<double>(variance.g) + static_cast<double>(variance.b)) / 3;
  return {mean * static_cast<double>(count), 1};
}

Image<KnownSum> sample_variances(const Term& term) {
  Image<KnownSum> values(term.used);
  for_each_row(term.used, [&](int y) {
    for (int x = 0; x < term.used.width; ++x) values(x, y) = sample_variance(term, x, y);
  });
  return values;
}

/// Mean over the known pixels; nothing where there are none.
std::optional<double> mean_of(const Image<KnownSum>& values) {
  KnownSum total;
  for (const KnownSum& value : values) total += value;
  if (total.known == 0) return std::nullopt;
  return total.sum / total.known;
}

/// The variances of one sample of a term, and what supports them.
struct SupportedVariances {
  Image<KnownSum> own, boxes;
  std::optional<double> mean;

  double at(int x, int y) const {
    const KnownSum &variance = own(x, y), &box = boxes(x, y);
    if (box.known == 0) return *mean;
    const double box_mean = box.sum / box.known;
    return variance.known > 0 ? std::max(variance.sum, box_mean / 2) : box_mean;
  }
};

/// factor count / (v + floor); 0 without samples.
Image<float> inverse_variances(const Term& weighted, const SupportedVariances& variances, double floor, double factor) {
  Image<float> weights(weighted.count->resolution());
  for_each_row(weighted.used, [&](int y) {
    for (int x = 0; x < weighted.used.width; ++x) {
      const auto count = static_cast<double>((*weighted.count)(x, y));
      weights(x, y) = static_cast<float>(factor * count / (variances.at(x, y) + floor));
    }
  });
  return weights;
}

}  // namespace

PoissonWeights count_weights(const ReconstructionBuffers& buffers, double alpha) {
  const Terms terms = terms_of(buffers);
  const double largest = std::max({largest_count(terms.primal), largest_count(terms.dx), largest_count(terms.dy)});
  const auto scaled = [&](const Image<float>& counts, double factor) {
    Image<float> weights(counts.resolution());
    if (largest == 0) return weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
      weights[i] = static_cast<float>(factor * static_cast<double>(counts[i]) / largest);
    return weights;
  };
  return {scaled(buffers.primal_count, alpha * alpha), scaled(buffers.dx_count, 1), scaled(buffers.dy_count, 1)};
}

PoissonWeights variance_weights(const ReconstructionBuffers& weighted, const ReconstructionBuffers& source,
                                const VarianceWeightOptions& options) {
  const Terms sources = terms_of(source), targets = terms_of(weighted);
  const auto supported = [&](const Term& term) {
    Image<KnownSum> own = sample_variances(term);
    // A term without pixels (the image is one pixel wide or high) needs no variance.
    const std::optional<double> mean = own.empty() ? 0.0 : mean_of(own);
    Image<KnownSum> boxes = box_sums(own, options.radius);
    return SupportedVariances{std::move(own), std::move(boxes), mean};
  };
  const SupportedVariances primal = supported(sources.primal), dx = supported(sources.dx), dy = supported(sources.dy);
  if (!primal.mean || !dx.mean || !dy.mean) return count_weights(weighted, k_default_alpha);
  const double largest_mean = std::max({*primal.mean, *dx.mean, *dy.mean});
  const double counts = std::max({largest_count(targets.primal), largest_count(targets.dx), largest_count(targets.dy)});
  if (largest_mean == 0 || counts == 0) return count_weights(weighted, k_default_alpha);

  const double unit = largest_mean / counts;  // weights of about 1, within float's range for images of any scale
  const auto weights = [&](const Term& target, const SupportedVariances& variances, double factor) {
    const double floor = std::max(k_floor * *variances.mean, k_lowest_floor * largest_mean);
    return inverse_variances(target, variances, floor, factor * unit);
  };
  return {weights(targets.primal, primal, options.lambda), weights(targets.dx, dx, 1), weights(targets.dy, dy, 1)};
}

ReconstructionResult solve_weighted(const ReconstructionBuffers& weighted, const ReconstructionBuffers& source,
                                    const VarianceWeightOptions& options, const SolverOptions& solver) {
  const PoissonWeights weights = variance_weights(weighted, source, options);
  return solve({weighted.primal, weighted.dx, weighted.dy, weights}, solver);
}

ReconstructionResult average_by_counts(const ReconstructionResult& a, const Image<float>& a_count,
                                       const ReconstructionResult& b, const Image<float>& b_count) {
  ReconstructionResult result{
      .image = RgbImage(a.image.resolution()),
      .statistics = {.iterations = a.statistics.iterations + b.statistics.iterations,
                     .relative_residual = std::max(a.statistics.relative_residual, b.statistics.relative_residual),
                     .converged = a.statistics.converged && b.statistics.converged}};
  for (std::size_t i = 0; i < result.image.size(); ++i) {
    const float count = a_count[i] + b_count[i];
    const float share = count > 0 ? a_count[i] / count : 0.5f;
    result.image[i] = b.image[i] + (a.image[i] - b.image[i]) * share;
  }
  return result;
}

}  // namespace gradslc
