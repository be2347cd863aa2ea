#pragma once

#include <random>

#include "reconstruction/screened_poisson.h"

namespace gradslc {

/// Owns the images that a ScreenedPoissonProblem refers to.
struct RandomProblem {
  RgbImage primal, dx, dy;
  PoissonWeights weights;

  /// Values in [-1, 1]; weights in [0.1, 1] times their scale, or 0 with the given probability.
  RandomProblem(Resolution resolution, unsigned seed, float primal_scale = 0.04f, float primal_zeros = 0,
                float gradient_zeros = 0)
      : primal(resolution), dx(resolution), dy(resolution) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-1, 1), weight(0.1f, 1), unit(0, 1);
    for (RgbImage* image : {&primal, &dx, &dy})
      for (Rgb& pixel : *image) {
        const float r = value(random), g = value(random), b = value(random);
        pixel = {r, g, b};
      }
    const auto random_weights = [&](float scale, float zeros) {
      Image<float> weights_of_term(resolution);
      for (float& w : weights_of_term) {
        w = scale * weight(random);
        if (unit(random) < zeros) w = 0;
      }
      return weights_of_term;
    };
    weights.primal = random_weights(primal_scale, primal_zeros);
    weights.dx = random_weights(1, gradient_zeros);
    weights.dy = random_weights(1, gradient_zeros);
  }

  ScreenedPoissonProblem problem() const { return {primal, dx, dy, weights}; }
};

/// dx and dy are set to the differences of `image`.
inline void set_differences(const RgbImage& image, RgbImage& dx, RgbImage& dy) {
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      if (x + 1 < image.width()) dx(x, y) = image(x + 1, y) - image(x, y);
      if (y + 1 < image.height()) dy(x, y) = image(x, y + 1) - image(x, y);
    }
}

}  // namespace gradslc
