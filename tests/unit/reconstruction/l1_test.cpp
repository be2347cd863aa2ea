#include <gtest/gtest.h>

#include <cmath>

#include "unit/reconstruction/method_test_support.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{9, 7};

ReconstructionInput exact_input() {
  std::mt19937_64 random(1);
  const auto silence = [](std::size_t, std::mt19937_64&) { return 0.0; };
  return sample_input(test_truth(k_resolution), 3, silence, silence, random);
}

/// A few values that are wrong by any amount leave a solution that fulfils all others: the sum of absolute deviations
/// has its minimum there. Squares spread the error.
TEST(L1, AFewWrongValuesDoNotMove) {
  const RgbImage truth = test_truth(k_resolution);
  for (const float wrong : {1.0f, 100.0f}) {
    ReconstructionInput input = exact_input();
    input.combined.primal(4, 3) += Rgb(wrong);
    input.combined.dx(1, 5) += Rgb(-wrong);
    input.combined.dy(6, 2) += Rgb(0, wrong, 0);
    const RgbImage image =
        make_reconstruction("l1", {{"reweightings", 40}, {"relative_residual", 1e-9}})->reconstruct(input).image;
    const RgbImage squares = make_reconstruction("l2")->reconstruct(input).image;
    double largest = 0, of_squares = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        largest = std::max(largest, static_cast<double>(std::abs(image[i][c] - truth[i][c])));
        of_squares = std::max(of_squares, static_cast<double>(std::abs(squares[i][c] - truth[i][c])));
      }
    EXPECT_LT(largest, 0.02 * static_cast<double>(wrong));
    EXPECT_GT(of_squares, 0.1 * static_cast<double>(wrong));
  }
}

TEST(L1, MoreReweightingsComeNearerToTheMinimum) {
  std::mt19937_64 random(2);
  const auto gaussian = [](std::size_t, std::mt19937_64& r) { return std::normal_distribution<double>(0, 0.5)(r); };
  const ReconstructionInput input = sample_input(test_truth(k_resolution), 6, gaussian, gaussian, random);
  constexpr double k_alpha = 0.2;
  const auto sum_of_deviations = [&](const RgbImage& image) {
    const auto norm = [](Rgb v) { return std::sqrt(static_cast<double>(v.r * v.r + v.g * v.g + v.b * v.b)); };
    const ReconstructionBuffers& b = input.combined;
    double sum = 0;
    for (int y = 0; y < k_resolution.height; ++y)
      for (int x = 0; x < k_resolution.width; ++x) {
        sum += k_alpha * norm(b.primal(x, y) - image(x, y));
        if (x + 1 < k_resolution.width) sum += norm(b.dx(x, y) - (image(x + 1, y) - image(x, y)));
        if (y + 1 < k_resolution.height) sum += norm(b.dy(x, y) - (image(x, y + 1) - image(x, y)));
      }
    return sum;
  };
  const auto after = [&](double reweightings) {
    const auto method = make_reconstruction("l1", {{"alpha", k_alpha}, {"reweightings", reweightings}});
    return sum_of_deviations(method->reconstruct(input).image);
  };
  const double one = after(1), eight = after(8), many = after(60);
  EXPECT_LT(eight, one);
  EXPECT_LT(eight, 1.01 * many);
  EXPECT_LT(many, sum_of_deviations(make_reconstruction("l2", {{"alpha", k_alpha}})->reconstruct(input).image));
}

}  // namespace
}  // namespace gradslc
