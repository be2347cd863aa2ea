#pragma once

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "reconstruction/reconstruction.h"
#include "unit/reconstruction/random_problem.h"

namespace gradslc {

/// Sets the parameters named in a map; booleans by 0 and 1.
class ParameterSetter final : public ParameterVisitor {
 public:
  explicit ParameterSetter(std::map<std::string, double> values) : values_(std::move(values)) {}
  ~ParameterSetter() override { EXPECT_TRUE(values_.empty()) << values_.begin()->first << " is not a parameter"; }

  void boolean(std::string_view name, bool& value, std::string_view) override { set(name, value, {0, 1}); }
  void integer(std::string_view name, std::int64_t& value, Range range, std::string_view, std::string_view) override {
    set(name, value, range);
  }
  void real(std::string_view name, double& value, Range range, std::string_view, std::string_view) override {
    set(name, value, range);
  }
  void choice(std::string_view name, std::size_t& index, const std::vector<std::string>& names,
              std::string_view) override {
    auto value = static_cast<std::int64_t>(index);
    set(name, value, {0, static_cast<double>(names.size() - 1)});
    index = static_cast<std::size_t>(value);
  }
  void group(std::string_view, std::string_view, const std::function<void()>& body) override { body(); }

 private:
  template <class T>
  void set(std::string_view name, T& value, Range range) {
    EXPECT_GE(static_cast<double>(value), range.lower) << name << ": default";
    EXPECT_LE(static_cast<double>(value), range.upper) << name << ": default";
    const auto found = values_.find(std::string(name));
    if (found == values_.end()) return;
    value = static_cast<T>(found->second);
    values_.erase(found);
  }

  std::map<std::string, double> values_;
};

inline std::unique_ptr<Reconstruction> make_reconstruction(const std::string& name,
                                                           const std::map<std::string, double>& parameters = {}) {
  for (const ReconstructionEntry& entry : reconstruction_registry())
    if (entry.name == name) {
      std::unique_ptr<Reconstruction> method = entry.make();
      ParameterSetter setter(parameters);
      method->describe(setter);
      return method;
    }
  ADD_FAILURE() << "no reconstruction " << name;
  return nullptr;
}

inline ReconstructionBuffers empty_buffers(Resolution resolution) {
  return {RgbImage(resolution),     RgbImage(resolution),     RgbImage(resolution),
          Image<float>(resolution), Image<float>(resolution), Image<float>(resolution),
          RgbImage(resolution),     RgbImage(resolution),     RgbImage(resolution)};
}

/// Estimates of `truth` by the mean of `sets` samples per pixel: sample = truth + noise(pixel, random) for the primal,
/// and likewise for the gradients; variances are estimated from the samples.
template <class PrimalNoise, class GradientNoise>
ReconstructionBuffers sample_half(const RgbImage& truth, int sets, const PrimalNoise& primal_noise,
                                  const GradientNoise& gradient_noise, std::mt19937_64& random) {
  ReconstructionBuffers half = empty_buffers(truth.resolution());
  RgbImage dx(truth.resolution()), dy(truth.resolution());
  set_differences(truth, dx, dy);
  const auto estimate = [&](Rgb value, const auto& noise, std::size_t i, Rgb& mean, Rgb& variance, float& count) {
    double sum = 0, square_sum = 0;
    for (int set = 0; set < sets; ++set) {
      const double sample = noise(i, random);
      sum += sample;
      square_sum += sample * sample;
    }
    mean = value + Rgb(static_cast<float>(sum / sets));
    variance = Rgb(static_cast<float>((square_sum - sum * sum / sets) / (sets - 1) / sets));
    count = static_cast<float>(sets);
  };
  for (std::size_t i = 0; i < truth.size(); ++i) {
    estimate(truth[i], primal_noise, i, half.primal[i], half.primal_variance[i], half.primal_count[i]);
    estimate(dx[i], gradient_noise, i, half.dx[i], half.dx_variance[i], half.dx_count[i]);
    estimate(dy[i], gradient_noise, i, half.dy[i], half.dy_variance[i], half.dy_count[i]);
  }
  return half;
}

/// One flat surface, seen at right angles, without noise.
inline FeatureBuffers flat_features(Resolution resolution) {
  return {RgbImage(resolution, Rgb(0.5f)),
          RgbImage(resolution, {0, 0, 1}),
          Image<float>(resolution, 3),
          RgbImage(resolution),
          RgbImage(resolution),
          Image<float>(resolution)};
}

/// Both halves together, as the film combines them: `sets` per half.
inline ReconstructionBuffers combine(const ReconstructionBuffers& a, const ReconstructionBuffers& b) {
  ReconstructionBuffers both = a;
  const auto merge = [](RgbImage& mean, RgbImage& variance, Image<float>& count, const RgbImage& other_mean,
                        const RgbImage& other_variance, const Image<float>& other_count) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const float n = count[i], m = other_count[i];
      if (n + m == 0) continue;
      const Rgb difference = other_mean[i] - mean[i];
      const Rgb scatter =
          variance[i] * (n * (n - 1)) + other_variance[i] * (m * (m - 1)) + difference * difference * (n * m / (n + m));
      mean[i] = (mean[i] * n + other_mean[i] * m) / (n + m);
      variance[i] = scatter / ((n + m) * (n + m - 1));
      count[i] = n + m;
    }
  };
  merge(both.primal, both.primal_variance, both.primal_count, b.primal, b.primal_variance, b.primal_count);
  merge(both.dx, both.dx_variance, both.dx_count, b.dx, b.dx_variance, b.dx_count);
  merge(both.dy, both.dy_variance, both.dy_count, b.dy, b.dy_variance, b.dy_count);
  return both;
}

template <class PrimalNoise, class GradientNoise>
ReconstructionInput sample_input(const RgbImage& truth, int sets_per_half, const PrimalNoise& primal_noise,
                                 const GradientNoise& gradient_noise, std::mt19937_64& random) {
  ReconstructionInput input;
  for (ReconstructionBuffers& half : input.halves)
    half = sample_half(truth, sets_per_half, primal_noise, gradient_noise, random);
  input.combined = combine(input.halves[0], input.halves[1]);
  input.features = flat_features(truth.resolution());
  return input;
}

/// Calls body(image) for all values of primal, dx and dy, and body(variance) likewise, of all three buffers.
template <class Body>
void for_all_buffers(ReconstructionInput& input, const Body& body) {
  body(input.halves[0]);
  body(input.halves[1]);
  body(input.combined);
}

/// A smooth image with an edge.
inline RgbImage test_truth(Resolution resolution) {
  RgbImage image(resolution);
  for (int y = 0; y < resolution.height; ++y)
    for (int x = 0; x < resolution.width; ++x) {
      const float base = 1 + 0.05f * static_cast<float>(x) + (2 * y > resolution.height ? 2.0f : 0.0f);
      image(x, y) = {base, 0.5f * base, 2};
    }
  return image;
}

}  // namespace gradslc
