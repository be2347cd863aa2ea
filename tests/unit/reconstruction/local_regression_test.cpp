#include "reconstruction/local_regression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "unit/reconstruction/method_test_support.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{40, 33};

RgbImage with_noise(const RgbImage& truth, float sigma, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> noise(0, sigma);
  RgbImage image = truth;
  for (Rgb& pixel : image) pixel += Rgb(noise(random), noise(random), noise(random));
  return image;
}

double square_error(const RgbImage& a, const RgbImage& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Rgb d = a[i] - b[i];
    sum += static_cast<double>(d.r * d.r + d.g * d.g + d.b * d.b);
  }
  return sum / static_cast<double>(a.size());
}

/// Two independent noisy images, filtered as one.
struct Halves {
  RgbImage a, b;
  RgbImage filtered(const FeatureBuffers& features, const RegressionOptions& options = {}) const {
    return filter({a, b, variance_of_halves(a, b), features}, options);
  }
};
Halves noisy_halves(const RgbImage& truth, float sigma) {
  return {with_noise(truth, sigma, 1), with_noise(truth, sigma, 2)};
}

TEST(LocalRegression, LeavesLinearFunctionsOfPlaceAsTheyAre) {
  RgbImage truth(k_resolution);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pixel p = k_resolution.pixel(i);
    truth[i] = {2 + 0.01f * static_cast<float>(p.x), 3 - 0.02f * static_cast<float>(p.y), 1};
  }
  const Image<float> wide(k_resolution, 1);
  const RgbImage image = filter({truth, truth, wide, flat_features(k_resolution)}, {});
  // At the border, where windows are cut off, the ridge pulls slopes towards 0: by 2 % of what a side of the window
  // differs by, 0.12.
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pixel p = k_resolution.pixel(i);
    const bool inside = p.x >= 6 && p.y >= 6 && p.x + 6 < k_resolution.width && p.y + 6 < k_resolution.height;
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(image[i][c], truth[i][c], inside ? 1e-5f : 3e-3f) << i;
  }
}

// Where all pixels of a window weigh the same the fit at its centre is their mean: the slopes see nothing of it.
TEST(LocalRegression, SpreadsASinglePixelOverItsWindow) {
  RgbImage values(k_resolution, Rgb(1));
  const Pixel centre{k_resolution.width / 2, k_resolution.height / 2};
  values[centre] = Rgb(5, 3, 2);
  const RgbImage guide(k_resolution, Rgb(1));
  const Image<float> variance(k_resolution, 1);
  for (const bool first_order : {true, false})
    for (const int radius : {1, 3, 6}) {
      const RegressionOptions options{.radius = radius, .first_order = first_order};
      const Rgb filtered = filter({values, guide, variance, flat_features(k_resolution)}, options)[centre];
      const auto pixels = static_cast<float>((2 * radius + 1) * (2 * radius + 1));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(filtered[c], 1 + (values[centre][c] - 1) / pixels, 1e-5f) << radius;
    }
}

TEST(LocalRegression, FollowsAlbedo) {
  RgbImage truth(k_resolution);
  FeatureBuffers features = flat_features(k_resolution);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> albedo(0.45f, 0.55f);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    features.albedo[i] = Rgb(albedo(random));  // a texture without any smoothness
    truth[i] = 4 * features.albedo[i];
  }
  const Image<float> wide(k_resolution, 1);
  const RgbImage image = filter({truth, truth, wide, features}, {});
  EXPECT_LT(square_error(image, truth), 1e-3 * square_error(truth, RgbImage(k_resolution, Rgb(2))));
}

// Two colours meet; they differ by 5 standard deviations of the noise. With their albedos the edge stays, and noise
// falls as over the 169 pixels of a window with 11 regressors.
TEST(LocalRegression, RemovesNoiseBesideAnEdge) {
  RgbImage truth(k_resolution);
  FeatureBuffers features = flat_features(k_resolution);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool left = k_resolution.pixel(i).x < 20;
    truth[i] = Rgb(left ? 1.0f : 1.5f), features.albedo[i] = Rgb(left ? 0.4f : 0.6f);
  }
  const Halves halves = noisy_halves(truth, 0.1f);
  const double noise = square_error(halves.a, truth), left = square_error(halves.filtered(features), truth);
  EXPECT_LT(left, 0.2 * noise);
  EXPECT_LT(square_error(halves.filtered(features, {.first_order = false}), truth), 0.2 * noise);
  FeatureBuffers none = flat_features(k_resolution);
  EXPECT_GT(square_error(halves.filtered(none), truth), left) << "only the guide tells the colours apart";
}

// What no feature shows is kept where the guide shows it clearly: a shadow of 20 standard deviations.
TEST(LocalRegression, KeepsWhatOnlyTheGuideShows) {
  RgbImage truth(k_resolution);
  for (std::size_t i = 0; i < truth.size(); ++i) truth[i] = Rgb(k_resolution.pixel(i).y < 15 ? 1.0f : 3.0f);
  const Halves halves = noisy_halves(truth, 0.1f);
  EXPECT_LT(square_error(halves.filtered(flat_features(k_resolution)), truth), 0.3 * square_error(halves.a, truth));
}

// Features that are noise are no guide: their variance widens what counts as alike.
TEST(LocalRegression, AllowsForTheNoiseOfFeatures) {
  const RgbImage truth(k_resolution, Rgb(1));
  FeatureBuffers features = flat_features(k_resolution);
  features.normal = with_noise(features.normal, 0.5f, 7);
  const Halves halves = noisy_halves(truth, 0.1f);
  const double unaware = square_error(halves.filtered(features), truth);
  features.normal_variance = RgbImage(k_resolution, Rgb(0.25f));
  EXPECT_LT(square_error(halves.filtered(features), truth), 0.7 * unaware);
}

TEST(VarianceOfHalves, IsThatOfOne) {
  const Halves halves = noisy_halves(RgbImage({200, 200}, Rgb(1)), 0.1f);
  const Image<float> variance = variance_of_halves(halves.a, halves.b);
  double mean = 0;
  for (const float v : variance) mean += static_cast<double>(v) / static_cast<double>(variance.size());
  const double expected = 0.01 * (0.2126 * 0.2126 + 0.7152 * 0.7152 + 0.0722 * 0.0722);
  EXPECT_NEAR(mean, expected, 0.03 * expected);  // 40,000 squares: 0.7 %
}

TEST(Feature, KeepsTheMeanWhereAsked) {
  std::mt19937_64 random(5);
  const auto noise = [](std::size_t, std::mt19937_64& r) {
    return std::lognormal_distribution<double>(-0.5, 1)(r) - 1;
  };
  const auto small = [](std::size_t, std::mt19937_64& r) { return std::normal_distribution<double>(0, 0.2)(r); };
  const ReconstructionInput input = sample_input(test_truth({30, 20}), 8, noise, small, random);
  const auto mean = [](const RgbImage& image) {
    double sum = 0;
    for (const Rgb& pixel : image) sum += static_cast<double>(pixel.g);
    return sum / static_cast<double>(image.size());
  };
  const double primal = mean(input.combined.primal);
  EXPECT_NEAR(mean(make_reconstruction("feature", {{"keep_mean", 1}})->reconstruct(input).image), primal,
              1e-4 * primal);
  EXPECT_GT(std::abs(mean(make_reconstruction("feature")->reconstruct(input).image) - primal), 1e-3 * primal)
      << "noise that is skewed moves the mean of the regression";
}

TEST(Feature, BeatsWeightedAndTheSameFilterWithoutGradients) {
  const RgbImage truth = test_truth({48, 40});
  const auto primal = [](std::size_t, std::mt19937_64& r) { return std::normal_distribution<double>(0, 1)(r); };
  const auto gradients = [](std::size_t, std::mt19937_64& r) { return std::normal_distribution<double>(0, 0.1)(r); };
  std::mt19937_64 random(6);
  const ReconstructionInput input = sample_input(truth, 8, primal, gradients, random);
  const auto error = [&](const std::string& name) {
    return square_error(make_reconstruction(name)->reconstruct(input).image, truth);
  };
  EXPECT_LT(error("feature"), error("weighted"));
  EXPECT_LT(error("feature"), error("denoise"));
  EXPECT_LT(error("denoise"), 0.5 * error("none"));
}

TEST(Feature, NeedsFeatures) {
  std::mt19937_64 random(7);
  const auto silence = [](std::size_t, std::mt19937_64&) { return 0.0; };
  ReconstructionInput input = sample_input(test_truth({8, 8}), 3, silence, silence, random);
  for (const char* name : {"feature", "denoise"}) {
    ReconstructionInput bad = input;
    bad.features = {};
    EXPECT_THROW(make_reconstruction(name)->reconstruct(bad), Error);
    bad = input;
    bad.features.depth[3] = std::nanf("");
    EXPECT_THROW(make_reconstruction(name)->reconstruct(bad), Error);
  }
}

}  // namespace
}  // namespace gradslc
