#include "film/film_io.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace gradslc {
namespace {

constexpr Resolution k_resolution{2, 1};
constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// Sets of one sample at pixel (1, 0): half a gets the values 1 and 3, half b 5 and an open set of 7.
Film sample_film(FilmLayers layers) {
  Film film(k_resolution, layers);
  const float values[2][2] = {{1, 3}, {5, 7}};
  for (int h = 0; h < 2; ++h)
    for (int set = 0; set < 2; ++set) {
      const Rgb value(values[h][set]);
      film.half(h).primal.add({1, 0}, value);
      if (layers.gradients) {
        film.half(h).dx.add({1, 0}, value * 2);
        film.half(h).dy.add({1, 0}, value * 3);
      }
      if (layers.parts) film.half(h).part_sums[static_cast<std::size_t>(Part::specular)](1, 0) += value;
      if (layers.debug) {
        DebugSample sample{.pass = static_cast<std::uint32_t>(2 * set + h), .cut_size = 2, .rays = 5};
        sample.failed_shifts = 3;
        sample.node_evaluations = value.r;
        sample.contribution = {10 - value.r, sample.pass, Part::specular};
        sample.value = value;
        film.half(h).debug.add({1, 0}, sample);
      }
      if (h == 0 || set == 0) film.close_set(h);
    }
  film.half(1).primal.add({0, 0}, Rgb(k_infinity));
  return film;
}

std::set<std::string> names_of(const std::map<std::string, ExrLayer>& layers) {
  std::set<std::string> names;
  for (const auto& [name, layer] : layers) names.insert(name);
  return names;
}

Rgb rgb_at(const std::map<std::string, ExrLayer>& layers, const std::string& name, int x = 1) {
  return std::get<RgbImage>(layers.at(name))(x, 0);
}
float grey_at(const std::map<std::string, ExrLayer>& layers, const std::string& name, int x = 1) {
  return std::get<Image<float>>(layers.at(name))(x, 0);
}

TEST(FilmLayersOfARun, AreNamedByWhatTheFilmRecorded) {
  const std::set<std::string> plain{"primal",   "variance",          "invalid",
                                    "primal_a", "primal_variance_a", "primal_count_a",
                                    "primal_b", "primal_variance_b", "primal_count_b"};
  EXPECT_EQ(names_of(film_layers(sample_film({}))), plain);
  std::set<std::string> full = plain;
  for (const std::string name : {"dx", "dy"}) {
    full.insert({name, name + "_variance"});
    for (const std::string half : {"_a", "_b"})
      full.insert({name + half, name + "_variance" + half, name + "_count" + half});
  }
  full.insert({"direct", "vpl", "compensation", "specular", "prefix"});
  EXPECT_EQ(names_of(film_layers(sample_film({.gradients = true, .parts = true}))), full);
  full.insert({"debug_cut_size", "debug_node_evaluations", "debug_rays", "debug_failed_shifts", "debug_contribution",
               "debug_contribution_part", "debug_contribution_pass", "debug_sample", "debug_sample_pass",
               "debug_dx_ratio", "debug_dy_ratio"});
  EXPECT_EQ(names_of(film_layers(sample_film({.gradients = true, .parts = true, .debug = true}))), full);
}

TEST(FilmLayersOfARun, HoldDebugImagesOfBothHalves) {
  const auto layers = film_layers(sample_film({.gradients = true, .debug = true}));
  EXPECT_EQ(grey_at(layers, "debug_cut_size"), 2);
  EXPECT_EQ(grey_at(layers, "debug_node_evaluations"), 4);
  EXPECT_EQ(grey_at(layers, "debug_rays"), 5);
  EXPECT_EQ(grey_at(layers, "debug_failed_shifts"), 3);
  EXPECT_FLOAT_EQ(grey_at(layers, "debug_dx_ratio"), 4);
  EXPECT_FLOAT_EQ(grey_at(layers, "debug_dy_ratio"), 9);
  EXPECT_EQ(grey_at(layers, "debug_dx_ratio", 0), 0) << "no samples";
  EXPECT_FLOAT_EQ(grey_at(layers, "debug_contribution"), 9);
  EXPECT_EQ(grey_at(layers, "debug_contribution_part"), 3);
  EXPECT_EQ(grey_at(layers, "debug_contribution_pass"), 0);
  EXPECT_FLOAT_EQ(grey_at(layers, "debug_sample"), 7);
  EXPECT_EQ(grey_at(layers, "debug_sample_pass"), 3);
  EXPECT_EQ(grey_at(layers, "debug_sample_pass", 0), 0);
}

TEST(FilmLayersOfARun, HoldMeansVariancesAndCounts) {
  const auto layers = film_layers(sample_film({.gradients = true, .parts = true}));
  EXPECT_EQ(rgb_at(layers, "primal"), Rgb(4));
  EXPECT_FLOAT_EQ(rgb_at(layers, "variance").r, 4.0f / 3);  // of the closed 1, 3, 5: scatter 4 over 3 sets
  EXPECT_EQ(rgb_at(layers, "primal_a"), Rgb(2));
  EXPECT_EQ(rgb_at(layers, "primal_b"), Rgb(6));
  EXPECT_EQ(rgb_at(layers, "primal_variance_a"), Rgb(1));
  EXPECT_EQ(rgb_at(layers, "primal_variance_b"), Rgb(k_infinity));
  EXPECT_EQ(grey_at(layers, "primal_count_b"), 2);
  EXPECT_EQ(rgb_at(layers, "dx"), Rgb(8));
  EXPECT_EQ(rgb_at(layers, "dy_a"), Rgb(6));
  EXPECT_EQ(rgb_at(layers, "dy_variance_a"), Rgb(9));
  EXPECT_EQ(rgb_at(layers, "specular"), Rgb(4));
  EXPECT_EQ(rgb_at(layers, "direct"), Rgb(0));
  EXPECT_EQ(grey_at(layers, "invalid", 0), 1);
  EXPECT_EQ(grey_at(layers, "invalid"), 0);
  EXPECT_EQ(rgb_at(layers, "variance", 0), Rgb(k_infinity));
}

}  // namespace
}  // namespace gradslc
