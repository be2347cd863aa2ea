#include "film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/parallel.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{3, 2};
constexpr Pixel k_pixel{1, 1};
constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// A method whose pass p (from 0) is the constant p + 1; `passes_per_set` passes make a set, sets alternate between
/// halves.
void render_counting_pass(int pass, int passes_per_set, Film& film) {
  const int half = pass / passes_per_set % 2;
  for (int y = 0; y < film.resolution().height; ++y)
    for (int x = 0; x < film.resolution().width; ++x)
      film.half(half).primal.add({x, y}, Rgb(static_cast<float>(pass + 1)));
  if (pass % passes_per_set == passes_per_set - 1) film.close_set(half);
}

TEST(Film, CountsEveryPassExactlyOnce) {
  Film film(k_resolution, {});
  for (int pass = 0; pass < 3; ++pass) render_counting_pass(pass, 1, film);
  EXPECT_EQ(film.half(0).primal.count(k_pixel), 2u);
  EXPECT_EQ(film.half(1).primal.count(k_pixel), 1u);
  EXPECT_EQ(film.half(0).primal.mean(k_pixel), Rgb(2));  // passes 1 and 3
  EXPECT_EQ(film.half(1).primal.mean(k_pixel), Rgb(2));
  for (const Rgb& value : film.primal()) EXPECT_EQ(value, Rgb(2));
}

TEST(Film, PrimalWeighsHalvesByTheirCounts) {
  Film film(k_resolution, {});
  film.half(0).primal.add(k_pixel, Rgb(1));
  film.half(0).primal.add(k_pixel, Rgb(1));
  film.half(0).primal.add(k_pixel, Rgb(1));
  film.half(1).primal.add(k_pixel, Rgb(5));
  EXPECT_EQ(film.primal()[k_pixel], Rgb(2));
  EXPECT_EQ(film.primal()(0, 0), Rgb(0)) << "no samples";
}

TEST(Moments, VarianceIsThatOfTheMeanOverPasses) {
  MomentImage image(k_resolution);
  for (const float value : {1.0f, 2.0f, 3.0f}) {
    image.add(k_pixel, Rgb(value, 2 * value, 5));
    image.close_set();
  }
  const Rgb variance = image.variance_of_mean(k_pixel);  // scatter 1, over 3 passes
  EXPECT_FLOAT_EQ(variance.r, 1.0f / 3);
  EXPECT_FLOAT_EQ(variance.g, 4.0f / 3);
  EXPECT_EQ(variance.b, 0);
  EXPECT_EQ(image.sets(k_pixel), 3u);
}

TEST(Moments, SetsOfSeveralPassesAreOneMomentSample) {
  MomentImage image(k_resolution);
  for (const float set : {1.0f, 3.0f}) {  // passes of a set scatter; only the sets' means 1 and 3 matter
    for (const float offset : {-1.0f, 0.0f, 1.0f}) image.add(k_pixel, Rgb(set + offset));
    image.close_set();
  }
  EXPECT_EQ(image.count(k_pixel), 6u);
  EXPECT_EQ(image.sets(k_pixel), 2u);
  EXPECT_FLOAT_EQ(image.variance_of_mean(k_pixel).r, 1.0f);  // ((1-2)^2 + (3-2)^2) / (2-1) / 2
}

TEST(Moments, UnevenCountsAreWeighted) {
  MomentImage image(k_resolution);
  for (const float value : {4.0f, 4.0f, 4.0f}) image.add(k_pixel, Rgb(value));
  image.close_set();
  image.add(k_pixel, Rgb(8));
  image.close_set();
  EXPECT_EQ(image.mean(k_pixel), Rgb(5));
  EXPECT_FLOAT_EQ(image.variance_of_mean(k_pixel).r, 3.0f);  // (3 (4-5)^2 + 1 (8-5)^2) / (2-1) / 4
}

TEST(Moments, OpenSetCountsInTheMeanButNotInTheVariance) {
  MomentImage image(k_resolution);
  for (const float value : {1.0f, 3.0f}) {
    image.add(k_pixel, Rgb(value));
    image.close_set();
  }
  image.add(k_pixel, Rgb(8));
  EXPECT_EQ(image.mean(k_pixel), Rgb(4));
  EXPECT_EQ(image.count(k_pixel), 3u);
  EXPECT_EQ(image.sets(k_pixel), 2u);
  EXPECT_FLOAT_EQ(image.variance_of_mean(k_pixel).r, 1.0f);
}

TEST(Moments, VarianceIsUnknownBelowTwoSets) {
  MomentImage image(k_resolution);
  EXPECT_EQ(image.variance_of_mean(k_pixel), Rgb(k_infinity));
  EXPECT_EQ(image.mean(k_pixel), Rgb(0));
  image.add(k_pixel, Rgb(1));
  image.add(k_pixel, Rgb(2));
  image.close_set();
  EXPECT_EQ(image.variance_of_mean(k_pixel), Rgb(k_infinity));
  image.close_set();
  EXPECT_EQ(image.sets(k_pixel), 1u) << "a set without samples is no set";
}

TEST(Moments, VarianceOfAConstantIsNotNegative) {
  for (int constant = 1; constant < 100; ++constant) {  // rounding takes some of them below zero without the clamp
    const float value = 0.1f * static_cast<float>(constant);
    MomentImage::Accumulator pixel;
    for (int set = 0; set < constant; ++set) {
      for (int sample = 0; sample < 3; ++sample) pixel.add(Rgb(value));
      pixel.close_set();
    }
    if (constant == 1) continue;
    EXPECT_GE(pixel.variance_of_mean().r, 0) << constant;
    EXPECT_LE(pixel.variance_of_mean().r, 1e-14f * value * value) << constant;
  }
}

TEST(Moments, InvalidSamplesAreCountedAndLeftOut) {
  Film film(k_resolution, {.gradients = true});
  MomentImage& primal = film.half(1).primal;
  primal.add(k_pixel, Rgb(1));
  primal.add(k_pixel, Rgb(0, k_nan, 0));
  primal.add(k_pixel, Rgb(0, 0, -k_infinity));
  film.half(0).dx.add({0, 0}, Rgb(k_infinity));
  film.close_set(1);
  EXPECT_EQ(primal.count(k_pixel), 1u);
  EXPECT_EQ(primal.invalid(k_pixel), 2u);
  EXPECT_EQ(primal.sets(k_pixel), 1u);
  EXPECT_EQ(film.primal()[k_pixel], Rgb(1));
  EXPECT_EQ(film.half(0).dx.mean({0, 0}), Rgb(0));
  EXPECT_EQ(film.invalid_samples(), 3u);
}

/// Few different luminances, so that passes tie.
DebugSample random_debug_sample(std::mt19937& random, int pass) {
  const auto number = [&](unsigned most) { return static_cast<float>(random() % (most + 1)); };
  DebugSample sample{.pass = static_cast<std::uint32_t>(pass), .value = Rgb(number(2))};
  sample.cut_size = number(10), sample.node_evaluations = number(100), sample.rays = random() % 10;
  sample.failed_shifts = random() % 5;
  sample.contribution = {number(2), pass, static_cast<Part>(random() % k_part_count)};
  return sample;
}

/// Sets `begin` to `end` of a method with whole-numbered samples (so that double sums are exact), uneven counts and
/// NaN.
void render_random_sets(int begin, int end, Film& film) {
  for (int set = begin; set < end; ++set) {
    std::mt19937 random(static_cast<unsigned>(set));
    FilmHalf& half = film.half(set % 2);
    for (MomentImage* image : {&half.primal, &half.dx, &half.dy})
      for (int sample = 0; sample < 4; ++sample)
        for (int x = 0; x < k_resolution.width; ++x) {
          const auto value = static_cast<float>(random() % 64);
          image->add({x, x % 2}, value == 0 ? Rgb(k_nan) : Rgb(value, 2 * value, -value));
        }
    if (film.layers().parts) half.part_sums[0](0, 0) += Rgb(static_cast<float>(set));
    if (film.layers().debug) half.debug.add({set % 3, 0}, random_debug_sample(random, set));
    film.close_set(set % 2);
  }
}

TEST(Film, MergedPartsEqualTheWhole) {
  constexpr FilmLayers layers{.gradients = true, .parts = true, .debug = true};
  Film whole(k_resolution, layers), merged(k_resolution, layers), rest(k_resolution, layers);
  render_random_sets(0, 40, whole);
  render_random_sets(0, 13, merged);
  render_random_sets(13, 40, rest);
  merged.merge(rest);
  for (int h = 0; h < 2; ++h)
    for (MomentImage FilmHalf::*image : {&FilmHalf::primal, &FilmHalf::dx, &FilmHalf::dy}) {
      const auto& expected = (whole.half(h).*image).accumulators();
      const auto& actual = (merged.half(h).*image).accumulators();
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(actual[i].sum, expected[i].sum);
        EXPECT_EQ(actual[i].count, expected[i].count);
        EXPECT_EQ(actual[i].sets, expected[i].sets);
        EXPECT_EQ(actual[i].invalid, expected[i].invalid);
        for (int c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(actual[i].square_sum[c], expected[i].square_sum[c]);
      }
    }
  for (std::size_t i = 0; i < k_resolution.pixels(); ++i) EXPECT_EQ(merged.debug()[i], whole.debug()[i]);
  EXPECT_EQ(merged.primal(), whole.primal());
  EXPECT_EQ(merged.part(Part::direct), whole.part(Part::direct));
  EXPECT_EQ(merged.invalid_samples(), whole.invalid_samples());
  EXPECT_GT(whole.invalid_samples(), 0u);
}

TEST(Film, ClosesTheSetsOfAllImagesOfOneHalf) {
  Film film(k_resolution, {.gradients = true});
  for (int h = 0; h < 2; ++h)
    for (MomentImage* image : {&film.half(h).primal, &film.half(h).dx, &film.half(h).dy}) image->add(k_pixel, Rgb(1));
  film.close_set(1);
  for (int h = 0; h < 2; ++h)
    for (const MomentImage* image : {&film.half(h).primal, &film.half(h).dx, &film.half(h).dy})
      EXPECT_EQ(image->sets(k_pixel), static_cast<std::uint32_t>(h));
}

TEST(Film, MergeKeepsHalvesApart) {
  Film film(k_resolution, {}), other(k_resolution, {});
  other.half(1).primal.add(k_pixel, Rgb(3));
  other.close_set(1);
  film.merge(other);
  EXPECT_EQ(film.half(0).primal.count(k_pixel), 0u);
  EXPECT_EQ(film.half(1).primal.mean(k_pixel), Rgb(3));
}

TEST(Film, PartsAreDividedByThePrimalsCount) {
  Film film(k_resolution, {.parts = true});
  for (int h = 0; h < 2; ++h)
    for (int pass = 0; pass <= h; ++pass) {
      film.half(h).primal.add(k_pixel, Rgb(3));
      film.half(h).part_sums[static_cast<std::size_t>(Part::vpl)][k_pixel] += Rgb(2);
      film.half(h).part_sums[static_cast<std::size_t>(Part::prefix)][k_pixel] += Rgb(1);
    }
  EXPECT_EQ(film.part(Part::vpl)[k_pixel], Rgb(2));
  EXPECT_EQ(film.part(Part::prefix)[k_pixel], Rgb(1));
  EXPECT_EQ(film.part(Part::vpl)(0, 0), Rgb(0));
}

TEST(Film, HasOnlyTheLayersAskedFor) {
  const Film plain(k_resolution, {});
  EXPECT_TRUE(plain.half(0).dx.accumulators().empty());
  EXPECT_TRUE(plain.half(0).part_sums.empty());
  EXPECT_TRUE(plain.half(0).debug.empty());
  const Film full(k_resolution, {.gradients = true, .parts = true, .debug = true});
  EXPECT_EQ(full.half(1).debug.resolution(), k_resolution);
  EXPECT_EQ(full.half(1).dy.resolution(), k_resolution);
  EXPECT_EQ(full.half(1).part_sums.size(), static_cast<std::size_t>(k_part_count));
}

TEST(Moments, DifferentPixelsMayBeAddedToConcurrently) {
  constexpr Resolution resolution{64, 64};
  MomentImage image(resolution);
  for (int pass = 0; pass < 20; ++pass) {
    parallel_for(resolution.pixels(), 7, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Pixel pixel{static_cast<int>(i) % resolution.width, static_cast<int>(i) / resolution.width};
        image.add(pixel, Rgb(static_cast<float>(i) + static_cast<float>(pass)));
      }
    });
    image.close_set();
  }
  for (int y = 0; y < resolution.height; ++y)
    for (int x = 0; x < resolution.width; ++x) {
      ASSERT_EQ(image.count({x, y}), 20u);
      ASSERT_FLOAT_EQ(image.mean({x, y}).r, static_cast<float>(y * resolution.width + x) + 9.5f);
    }
}

/// The estimate of the variance is unbiased: over many films of Gaussian samples in uneven, independent sets its mean
/// is the true variance of the mean. False alarms: |z| > 3.89, one in 10,000.
TEST(Moments, VarianceEstimateIsUnbiased) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> gauss(3.0, 2.0);
  constexpr int k_films = 4000, k_samples = 1 + 2 + 3 + 4;
  double sum = 0, square_sum = 0;
  for (int film = 0; film < k_films; ++film) {
    MomentImage::Accumulator pixel;
    for (int set = 1; set <= 4; ++set) {
      for (int i = 0; i < set; ++i) pixel.add(Rgb(static_cast<float>(gauss(random))));
      pixel.close_set();
    }
    const double variance = static_cast<double>(pixel.variance_of_mean().r);
    sum += variance;
    square_sum += variance * variance;
  }
  const double mean = sum / k_films;
  const double standard_error = std::sqrt((square_sum / k_films - mean * mean) / (k_films - 1));
  EXPECT_LT(std::abs(mean - 4.0 / k_samples), 3.89 * standard_error);
}

}  // namespace
}  // namespace gradslc
