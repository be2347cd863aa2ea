#include "reconstruction/outliers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/parallel.h"

namespace gradslc {
namespace {

constexpr int k_side = 16;         // pixels of a square
constexpr double k_trimmed = 0.1;  // share of a square's differences that its mean leaves out
constexpr float k_unknown = std::numeric_limits<float>::infinity();

/// One of the three terms of some buffers.
struct Term {
  RgbImage *mean, *variance;
  Image<float>* count;
};
using TermOf = Term (*)(ReconstructionBuffers&);
constexpr TermOf k_terms[] = {[](ReconstructionBuffers& b) {
                                return Term{&b.primal, &b.primal_variance, &b.primal_count};
                              },
                              [](ReconstructionBuffers& b) {
                                return Term{&b.dx, &b.dx_variance, &b.dx_count};
                              },
                              [](ReconstructionBuffers& b) {
                                return Term{&b.dy, &b.dy_variance, &b.dy_count};
                              }};

float largest(Rgb value) { return std::max({std::abs(value.r), std::abs(value.g), std::abs(value.b)}); }

/// Differences of the halves; negative where one has no sample.
Image<float> differences(const Term& a, const Term& b) {
  Image<float> found(a.mean->resolution(), -1);
  for (std::size_t i = 0; i < found.size(); ++i)
    if ((*a.count)[i] > 0 && (*b.count)[i] > 0) found[i] = largest((*a.mean)[i] - (*b.mean)[i]);
  return found;
}

/// Mean of the smaller differences in each square; 0 where there is none.
Image<float> usual_differences(const Image<float>& all) {
  const auto squares = [](int pixels) { return (pixels + k_side - 1) / k_side; };
  Image<float> usual({squares(all.width()), squares(all.height())});
  parallel_for(usual.size(), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<float> values;
    for (std::size_t i = begin; i < end; ++i) {
      const Pixel square = usual.resolution().pixel(i);
      values.clear();
      for (int y = square.y * k_side; y < std::min(all.height(), (square.y + 1) * k_side); ++y)
        for (int x = square.x * k_side; x < std::min(all.width(), (square.x + 1) * k_side); ++x)
          if (all(x, y) >= 0) values.push_back(all(x, y));
      std::sort(values.begin(), values.end());
      values.resize(values.size() - static_cast<std::size_t>(k_trimmed * static_cast<double>(values.size())));
      double sum = 0;
      for (const float value : values) sum += static_cast<double>(value);
      if (!values.empty()) usual[i] = static_cast<float>(sum / static_cast<double>(values.size()));
    }
  });
  return usual;
}

/// The largest of a square and the four beside it.
float usual_nearby(const Image<float>& usual, Pixel square) {
  float found = usual[square];
  for (const Pixel step : {Pixel{-1, 0}, Pixel{1, 0}, Pixel{0, -1}, Pixel{0, 1}})
    if (const Pixel beside = square + step; usual.resolution().contains(beside)) found = std::max(found, usual[beside]);
  return found;
}

void set(const Term& to, const Term& from, std::size_t i) {
  (*to.mean)[i] = (*from.mean)[i], (*to.variance)[i] = (*from.variance)[i], (*to.count)[i] = (*from.count)[i];
}

std::size_t remove_from(ReconstructionInput& input, TermOf term_of, float threshold) {
  const Term halves[2] = {term_of(input.halves[0]), term_of(input.halves[1])};
  const Term combined = term_of(input.combined);
  const Image<float> all = differences(halves[0], halves[1]), usual = usual_differences(all);
  std::size_t removed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Pixel pixel = all.resolution().pixel(i);
    const float limit = threshold * usual_nearby(usual, {pixel.x / k_side, pixel.y / k_side});
    if (!(limit > 0) || all[i] <= limit || !std::isfinite(all[i]))
      continue;  // what is infinite is for others to report
    const bool second = largest((*halves[1].mean)[i]) > largest((*halves[0].mean)[i]);
    const Term &outlier = halves[second ? 1 : 0], &other = halves[second ? 0 : 1];
    set(combined, other, i);
    (*outlier.mean)[i] = (*other.mean)[i];
    (*outlier.variance)[i] = Rgb(k_unknown);
    (*outlier.count)[i] = 0;
    ++removed;
  }
  return removed;
}

class OutlierOption final : public Reconstruction {
 public:
  explicit OutlierOption(std::unique_ptr<Reconstruction> reconstruction) : reconstruction_(std::move(reconstruction)) {}

  void describe(ParameterVisitor& visitor) override {
    reconstruction_->describe(visitor);
    visitor.group("outliers", "values that only one half of the passes has met", [&] {
      visitor.boolean("remove", remove_, "leave them out (biased: darkens)");
      visitor.real("threshold", threshold_, {1, 1e6}, "",
                   "how many times the usual difference between the halves nearby makes one");
    });
  }
  bool needs_features() const override { return reconstruction_->needs_features(); }

  ReconstructionResult reconstruct(const ReconstructionInput& input) const override {
    if (!remove_) return reconstruction_->reconstruct(input);
    const CleanedInput cleaned = without_outliers(input, threshold_);
    ReconstructionResult result = reconstruction_->reconstruct(cleaned.input);
    result.statistics.outliers = cleaned.removed;
    return result;
  }

 private:
  std::unique_ptr<Reconstruction> reconstruction_;
  bool remove_ = false;
  double threshold_ = 12;
};

}  // namespace

CleanedInput without_outliers(const ReconstructionInput& input, double threshold) {
  CleanedInput cleaned{input, 0};
  for (const TermOf term : k_terms)
    if (const Term first = term(cleaned.input.halves[0]); !first.mean->empty())
      cleaned.removed += remove_from(cleaned.input, term, static_cast<float>(threshold));
  return cleaned;
}

std::unique_ptr<Reconstruction> with_outlier_option(std::unique_ptr<Reconstruction> reconstruction) {
  return std::make_unique<OutlierOption>(std::move(reconstruction));
}

}  // namespace gradslc
