#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "unit/reconstruction/method_test_support.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{14, 11};
constexpr float k_infinity = std::numeric_limits<float>::infinity();
constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();

auto gaussian(double sigma) {
  return [sigma](std::size_t, std::mt19937_64& random) { return std::normal_distribution<double>(0, sigma)(random); };
}

ReconstructionInput noisy_input(unsigned seed, const RgbImage& truth = test_truth(k_resolution)) {
  std::mt19937_64 random(seed);
  return sample_input(truth, 6, gaussian(0.5), gaussian(0.2), random);
}

/// Every method, and those with several ways in all of them.
std::vector<std::pair<std::string, std::unique_ptr<Reconstruction>>> all_methods() {
  std::vector<std::pair<std::string, std::unique_ptr<Reconstruction>>> methods;
  for (const ReconstructionEntry& entry : reconstruction_registry()) methods.emplace_back(entry.name, entry.make());
  methods.emplace_back("weighted without cross", make_reconstruction("weighted", {{"cross", 0}}));
  methods.emplace_back("feature, mean kept", make_reconstruction("feature", {{"keep_mean", 1}}));
  methods.emplace_back("denoise, bilateral", make_reconstruction("denoise", {{"kind", 1}}));
  return methods;
}

TEST(Registry, ListsEveryMethodOnce) {
  std::set<std::string> names, with_gradients, with_features;
  for (const ReconstructionEntry& entry : reconstruction_registry()) {
    EXPECT_TRUE(names.insert(entry.name).second);
    make_reconstruction(entry.name);  // checks that defaults are in range
    if (entry.needs_gradients) with_gradients.insert(entry.name);
    if (entry.make()->needs_features()) with_features.insert(entry.name);
  }
  EXPECT_EQ(names, (std::set<std::string>{"none", "l2", "l1", "weighted", "feature", "denoise"}));
  EXPECT_EQ(with_gradients, (std::set<std::string>{"l2", "l1", "weighted", "feature"}));
  EXPECT_EQ(with_features, (std::set<std::string>{"feature", "denoise"}));
}

TEST(None, ReturnsThePrimalAndNeedsNoGradients) {
  ReconstructionInput input = noisy_input(1);
  input.combined.dx = input.combined.dy = RgbImage();
  EXPECT_EQ(make_reconstruction("none")->reconstruct(input).image, input.combined.primal);
}

TEST(AllMethods, GiveAConstantImageToTheLastPixel) {
  for (const Resolution resolution : {k_resolution, Resolution{1, 9}, Resolution{9, 1}, Resolution{1, 1}}) {
    RgbImage truth(resolution, {0.3f, 7, 1e-8f});
    std::mt19937_64 random(1);
    const auto silence = [](std::size_t, std::mt19937_64&) { return 0.0; };
    const ReconstructionInput input = sample_input(truth, 3, silence, silence, random);
    for (const auto& [name, method] : all_methods()) EXPECT_EQ(method->reconstruct(input).image, truth) << name;
  }
}

/// A few exact binary scales: all bits agree; and 1000, to rounding.
TEST(AllMethods, ScaleWithTheImage) {
  const ReconstructionInput input = noisy_input(2);
  for (const auto& [name, method] : all_methods()) {
    const RgbImage expected = method->reconstruct(input).image;
    for (const float scale : {0x1p-20f, 1000.0f, 0x1p30f}) {
      ReconstructionInput scaled = input;
      for_all_buffers(scaled, [&](ReconstructionBuffers& buffers) {
        for (RgbImage* image : {&buffers.primal, &buffers.dx, &buffers.dy})
          for (Rgb& value : *image) value *= scale;
        for (RgbImage* image : {&buffers.primal_variance, &buffers.dx_variance, &buffers.dy_variance})
          for (Rgb& value : *image) value = value * scale * scale;
      });
      const RgbImage image = method->reconstruct(scaled).image;
      const float tolerance = scale == 1000.0f ? 1e-4f : 0;
      for (std::size_t i = 0; i < image.size(); ++i)
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(image[i][c] / scale, expected[i][c], tolerance * expected[i][c]) << name << ", " << scale;
    }
  }
}

TEST(AllMethods, GiveTheSameBitsForAnyNumberOfThreads) {
  const ReconstructionInput input = noisy_input(3, test_truth({400, 101}));  // several chunks
  const std::map<std::string, double> coarse = {{"relative_residual", 0.05}};
  std::vector<std::unique_ptr<Reconstruction>> methods;
  methods.push_back(make_reconstruction("l2", coarse));
  methods.push_back(make_reconstruction("weighted", coarse));
  methods.push_back(make_reconstruction("feature", coarse));
  for (const std::unique_ptr<Reconstruction>& method : methods) {
    set_thread_count(1);
    const ReconstructionResult expected = method->reconstruct(input);
    EXPECT_GT(expected.statistics.iterations, 0);
    for (const int threads : {2, 7}) {
      set_thread_count(threads);
      EXPECT_EQ(method->reconstruct(input).image, expected.image) << threads;
    }
    set_thread_count(0);
  }
}

/// The message of the Error that a method throws.
std::string error_of(const Reconstruction& method, const ReconstructionInput& input) {
  try {
    method.reconstruct(input);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.message();
  }
  return "no error";
}

TEST(AllMethods, NameThePixelOfABadValue) {
  const auto broken = [](const std::function<void(ReconstructionBuffers&)>& change) {
    ReconstructionInput input = noisy_input(4);
    for_all_buffers(input, change);
    return input;
  };
  const std::vector<std::pair<std::string, ReconstructionInput>> primal_cases = {
      {"primal of pixel (3, 2)", broken([](auto& b) { b.primal(3, 2).g = k_nan; })},
      {"primal of pixel (13, 10)", broken([](auto& b) { b.primal(13, 10).b = -k_infinity; })},
      {"count of primal of pixel (1, 0)", broken([](auto& b) { b.primal_count(1, 0) = -1; })},
      {"variance of primal of pixel (0, 1)", broken([](auto& b) { b.primal_variance(0, 1).r = k_nan; })},
      {"no pixels", broken([](auto& b) { b = ReconstructionBuffers{}; })},
      {"has 2 x 2 pixels", broken([](auto& b) {
         b.primal_count = Image<float>({2, 2});
       })},
  };
  const std::vector<std::pair<std::string, ReconstructionInput>> gradient_cases = {
      {"dx of pixel (12, 2)", broken([](auto& b) { b.dx(12, 2).r = k_nan; })},
      {"dy of pixel (13, 9)", broken([](auto& b) { b.dy(13, 9).r = k_infinity; })},
      {"count of dy of pixel (0, 0)", broken([](auto& b) { b.dy_count(0, 0) = k_nan; })},
      {"variance of dx of pixel (5, 6)", broken([](auto& b) { b.dx_variance(5, 6).g = -1; })},
      {"has 0 x 0 pixels", broken([](auto& b) { b.dy = RgbImage(); })},
  };
  for (const auto& [name, method] : all_methods()) {
    for (const auto& [message, input] : primal_cases)
      EXPECT_NE(error_of(*method, input).find(message), std::string::npos) << name << ": " << error_of(*method, input);
    if (name == "none" || name.starts_with("denoise")) continue;
    for (const auto& [message, input] : gradient_cases)
      EXPECT_NE(error_of(*method, input).find(message), std::string::npos) << name << ": " << error_of(*method, input);
  }
}

TEST(AllMethods, DoNotLookAtUnusedGradients) {
  ReconstructionInput input = noisy_input(5);
  for_all_buffers(input, [](ReconstructionBuffers& b) {
    b.dx(13, 4) = b.dx_variance(13, 4) = Rgb(k_nan);
    b.dy(3, 10) = b.dy_variance(3, 10) = Rgb(k_nan);
  });
  for (const auto& [name, method] : all_methods()) {
    const RgbImage expected = method->reconstruct(noisy_input(5)).image;
    EXPECT_EQ(method->reconstruct(input).image, expected) << name;
  }
}

TEST(AllMethods, GiveFiniteImagesWithoutSamples) {
  for (const bool some : {false, true}) {
    ReconstructionInput input;
    input.features = flat_features(k_resolution);
    for_all_buffers(input, [&](ReconstructionBuffers& b) {
      b = empty_buffers(k_resolution);
      for (RgbImage* variance : {&b.primal_variance, &b.dx_variance, &b.dy_variance})
        for (Rgb& value : *variance) value = Rgb(k_infinity);
      if (!some) return;
      b.primal(3, 3) = Rgb(2);
      b.primal_count(3, 3) = b.dx_count(3, 3) = b.dy_count(7, 7) = 1;
    });
    for (const auto& [name, method] : all_methods()) {
      const RgbImage image = method->reconstruct(input).image;
      for (int y = 0; y < k_resolution.height; ++y)
        for (int x = 0; x < k_resolution.width; ++x) {
          const bool has_gradients = name != "none" && !name.starts_with("denoise");
          const bool joined = some && y == 3 && (x == 3 || (x == 4 && has_gradients));
          ASSERT_TRUE(is_finite(image(x, y))) << name;
          // One value and gradients everywhere: the solver stops when the residual is small, not the error.
          if (name == "feature, mean kept") continue;
          for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(image(x, y)[c], joined ? 2 : 0, 1e-4f) << name << " " << x << "," << y;
        }
    }
  }
}

TEST(L2, IsLinear) {
  const ReconstructionInput a = noisy_input(6), b = noisy_input(7);
  ReconstructionInput sum = a;
  for (RgbImage ReconstructionBuffers::*image :
       {&ReconstructionBuffers::primal, &ReconstructionBuffers::dx, &ReconstructionBuffers::dy})
    for (std::size_t i = 0; i < k_resolution.pixels(); ++i)
      (sum.combined.*image)[i] = (a.combined.*image)[i] + (b.combined.*image)[i] * -3;
  const auto method = make_reconstruction("l2", {{"relative_residual", 1e-9}});
  const RgbImage image_a = method->reconstruct(a).image, image_b = method->reconstruct(b).image;
  const RgbImage image = method->reconstruct(sum).image;
  for (std::size_t i = 0; i < image.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image[i][c], image_a[i][c] - 3 * image_b[i][c], 1e-5f);
}

double square_error(const RgbImage& image, const RgbImage& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < image.size(); ++i)
    for (int c = 0; c < 3; ++c) sum += std::pow(static_cast<double>(image[i][c] - truth[i][c]), 2);
  return sum / (3 * static_cast<double>(image.size()));
}

TEST(L2, AlphaWeighsThePrimal) {
  const ReconstructionInput input = noisy_input(8);
  const RgbImage close = make_reconstruction("l2", {{"alpha", 100}})->reconstruct(input).image;
  EXPECT_LT(square_error(close, input.combined.primal), 1e-6);
  const RgbImage smooth = make_reconstruction("l2", {{"alpha", 0.01}})->reconstruct(input).image;
  EXPECT_GT(square_error(smooth, input.combined.primal), 1e-3);
}

/// Skewed noise, uneven counts that do not depend on it: the mean of every pixel over many inputs is the truth.
/// False alarms: 0.1 % for the whole test, Sidak over 3 x 30 values: |z| > 4.4.
TEST(L2, IsUnbiased) {
  constexpr Resolution k_small{6, 5};
  constexpr int k_trials = 3000;
  const RgbImage truth = test_truth(k_small);
  const auto skewed = [](std::size_t, std::mt19937_64& random) {
    return std::exponential_distribution<double>(1)(random) - 1;
  };
  const auto method = make_reconstruction("l2");
  std::mt19937_64 random(9);
  std::vector<double> sum(3 * truth.size()), square_sum(3 * truth.size());
  for (int trial = 0; trial < k_trials; ++trial) {
    ReconstructionInput input;
    input.combined = sample_half(truth, 2, skewed, skewed, random);
    for (Image<float>* counts : {&input.combined.primal_count, &input.combined.dx_count, &input.combined.dy_count})
      for (float& count : *counts) count = static_cast<float>(random() % 3);
    input.combined.primal_count(2, 2) = 1;
    for (Image<float>* counts : {&input.combined.dx_count, &input.combined.dy_count})
      for (float& count : *counts) count += 1;
    const RgbImage image = method->reconstruct(input).image;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double error =
          static_cast<double>(image[i / 3][static_cast<int>(i % 3)] - truth[i / 3][static_cast<int>(i % 3)]);
      sum[i] += error;
      square_sum[i] += error * error;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / k_trials;
    const double standard_error = std::sqrt((square_sum[i] / k_trials - mean * mean) / (k_trials - 1));
    EXPECT_LT(std::abs(mean / standard_error), 4.4) << "pixel " << i / 3;
  }
}

/// Noise that differs from pixel to pixel by a factor of 30, which counts do not show.
TEST(Weighted, BeatsL2AndThePrimalWhereNoiseIsUneven) {
  constexpr Resolution k_size{32, 32};
  const RgbImage truth = test_truth(k_size);
  const auto noisy = [](std::size_t i) { return (i % 32) / 8 % 2 == 1; };  // stripes of 8 pixels
  const auto primal_noise = [&](std::size_t i, std::mt19937_64& random) {
    return std::normal_distribution<double>(0, noisy(i) ? 1.5 : 0.05)(random);
  };
  const auto gradient_noise = [&](std::size_t i, std::mt19937_64& random) {
    return std::normal_distribution<double>(0, i % 7 == 0 ? 1.5 : 0.05)(random);
  };
  std::mt19937_64 random(10);
  double cross = 0, own = 0, l2 = 0, primal = 0;
  for (int trial = 0; trial < 6; ++trial) {
    const ReconstructionInput input = sample_input(truth, 10, primal_noise, gradient_noise, random);
    const auto error = [&](const std::string& name, const std::map<std::string, double>& parameters) {
      const ReconstructionResult result = make_reconstruction(name, parameters)->reconstruct(input);
      EXPECT_TRUE(result.statistics.converged);
      return square_error(result.image, truth);
    };
    cross += error("weighted", {});
    own += error("weighted", {{"cross", 0}});
    l2 += error("l2", {});
    primal += error("none", {});
  }
  EXPECT_LT(cross, 0.5 * std::min(l2, primal));
  EXPECT_LT(own, cross);
}

/// z-value of the mean error of an image over many inputs with skewed noise.
double mean_error_z(const std::map<std::string, double>& parameters) {
  constexpr Resolution k_size{12, 12};
  constexpr int k_trials = 200;
  const RgbImage truth(k_size, Rgb(2));
  const auto fireflies = [](std::size_t, std::mt19937_64& random) {
    return std::lognormal_distribution<double>(-0.5, 1)(random) - 1;
  };
  const auto method = make_reconstruction("weighted", parameters);
  std::mt19937_64 random(11);
  double sum = 0, square_sum = 0;
  for (int trial = 0; trial < k_trials; ++trial) {
    const RgbImage image = method->reconstruct(sample_input(truth, 8, fireflies, gaussian(0.5), random)).image;
    double error = 0;
    for (const Rgb& pixel : image) error += static_cast<double>(pixel.r) - 2;
    sum += error;
    square_sum += error * error;
  }
  const double mean = sum / k_trials;
  return mean / std::sqrt((square_sum / k_trials - mean * mean) / (k_trials - 1));
}

/// False alarms: 0.1 % (|z| > 3.29). The control shows that the noise is such that own weights darken.
TEST(Weighted, CrossShowsNoBiasWhereOwnWeightsDarken) {
  EXPECT_LT(std::abs(mean_error_z({{"cross", 1}, {"radius", 0}})), 3.29);
  EXPECT_LT(mean_error_z({{"cross", 0}, {"radius", 0}}), -8);
}

TEST(Weighted, CrossAveragesHalvesByCounts) {
  ReconstructionInput input = noisy_input(12);
  for (Image<float>* counts : {&input.halves[1].primal_count, &input.halves[1].dx_count, &input.halves[1].dy_count})
    for (float& count : *counts) count = 0;
  const RgbImage image = make_reconstruction("weighted")->reconstruct(input).image;
  input.halves[1] = input.halves[0];  // known variances again, but the same samples
  for (ReconstructionBuffers& half : input.halves)
    for (RgbImage* variance : {&half.primal_variance, &half.dx_variance, &half.dy_variance})
      for (Rgb& value : *variance) value = Rgb(k_infinity);
  EXPECT_EQ(make_reconstruction("weighted")->reconstruct(input).image, image) << "an empty half counts for nothing";
}

}  // namespace
}  // namespace gradslc
