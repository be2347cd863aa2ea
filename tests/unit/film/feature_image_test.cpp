#include "film/feature_image.h"

#include <gtest/gtest.h>

#include "film/film_io.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{3, 2};

TEST(FeatureImage, KeepsMeansAndVariancesOfMeans) {
  FeatureImage image(k_resolution);
  image.add({1, 1}, {{0.5f, 0.25f, 1}, {0, 0, 1}, 4});
  image.add({1, 1}, {{0.25f, 0.25f, 0}, {0, 1, 0}, 8});
  const std::size_t index = k_resolution.index({1, 1});
  const auto both = image.moments(index, 2);
  EXPECT_EQ(both.mean.albedo, Rgb(0.375f, 0.25f, 0.5f));
  EXPECT_EQ(both.mean.normal.z, 0.5f);
  EXPECT_EQ(both.mean.depth, 6);
  EXPECT_EQ(both.variance.depth, 4) << "scatter 8 over one degree of freedom and two samples";
  EXPECT_EQ(both.variance.albedo.g, 0);
  const auto of_four = image.moments(index, 4);  // two samples that show no surface
  EXPECT_EQ(of_four.mean.depth, 3);
  EXPECT_FLOAT_EQ(of_four.variance.depth, (80.0f - 4 * 9) / 3 / 4);
  EXPECT_EQ(image.moments(0, 5).mean.depth, 0);
  EXPECT_EQ(image.moments(0, 0).variance.depth, 0);
}

TEST(FeatureImage, FilmsMergeItAndWriteItsLayers) {
  Film whole(k_resolution, {.features = true}), part(k_resolution, {.features = true});
  const auto sample = [](Film& film, int half, float depth) {
    film.half(half).primal.add({0, 1}, Rgb(1));
    const FeatureSink sink = film.half(half).feature_sink({0, 1});
    sink.image->add(sink.pixel, {Rgb(0.5f), {1, 0, 0}, depth});
    film.close_set(half);
  };
  sample(whole, 0, 1), sample(whole, 1, 2), sample(part, 1, 6);
  whole.merge(part);
  const auto layers = film_layers(whole);
  EXPECT_EQ(std::get<Image<float>>(layers.at("depth"))(0, 1), 3);
  EXPECT_EQ(std::get<Image<float>>(layers.at("depth"))(0, 0), 0);
  EXPECT_EQ(std::get<RgbImage>(layers.at("albedo"))(0, 1), Rgb(0.5f));
  EXPECT_EQ(std::get<RgbImage>(layers.at("normal"))(0, 1), Rgb(1, 0, 0));
  EXPECT_FLOAT_EQ(std::get<Image<float>>(layers.at("depth_variance"))(0, 1), 14.0f / 2 / 3);
  EXPECT_EQ(Film(k_resolution, {}).half(0).feature_sink({0, 0}).image, nullptr);
}

}  // namespace
}  // namespace gradslc
