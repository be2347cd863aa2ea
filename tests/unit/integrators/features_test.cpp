// Every integrator records the surfaces that its pixels show.

#include <gtest/gtest.h>

#include <cmath>

#include "film/film_io.h"
#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{16, 12};

std::vector<Method> every_method() {
  std::vector<Method> methods = {
      {"spt", "spt", {}}, {"gpt", "gpt", {}}, {"gpt replay", "gpt", {{"shift", "random_replay"}}}};
  const auto add = [&](const char* integrator, std::map<std::string, ParameterValue> more) {
    more.insert({"vpl/light_paths", 100.0});
    methods.push_back({integrator, integrator, more});
  };
  add("vpl", {}), add("lightcuts", {}), add("slc", {}), add("slc", {{"gather", "tile"}});
  for (const char* gather : {"descent", "tile"})
    for (const char* shift : {"reconnection", "random_replay", "block"})
      add("gradslc", {{"gather", gather}, {"shift", shift}, {"tile/size", 8.0}});
  return methods;
}

FeatureLayers features(const Method& method, const Scene& scene, std::uint32_t passes) {
  const auto integrator = method.make();
  integrator->prepare(scene, {.max_depth = 5});
  Film film(scene.camera().resolution(), {.gradients = integrator->traits().gradients, .features = true});
  for (std::uint32_t pass = 0; pass < passes; ++pass) integrator->render_pass(pass, film);
  return feature_layers(film);
}

TEST(Features, AreThoseOfTheSurface) {
  const Scene scene = closed_furnace({0.25f, 0.5f, 0.75f}, k_resolution);
  for (const Method& method : every_method()) {
    const FeatureLayers layers = features(method, scene, 3);
    for (std::size_t i = 0; i < k_resolution.pixels(); ++i) {
      EXPECT_EQ(layers.albedo[i], Rgb(0.25f, 0.5f, 0.75f)) << method.label;
      EXPECT_EQ(layers.albedo_variance[i], Rgb(0)) << method.label;
      EXPECT_GT(layers.depth[i], 0) << method.label;
      EXPECT_LT(layers.depth[i], 4) << method.label;
    }
  }
}

// A box with a mirror: through it they show what is behind. The same on average whatever the method.
TEST(Features, AgreeBetweenMethods) {
  const Scene scene = test_box(k_resolution, {.mirror = true});
  const FeatureLayers expected = features({"spt", "spt", {}}, scene, 256);
  double beyond = 0;
  for (const float depth : expected.depth) beyond += depth > 3.6f;
  EXPECT_GT(beyond, 0) << "no wall of the box is as far from the camera";
  for (const Method& method : every_method()) {
    const FeatureLayers layers = features(method, scene, 64);
    double depth_error = 0, albedo_error = 0, normal_error = 0;
    const auto squared = [](Rgb a) { return static_cast<double>(a.r * a.r + a.g * a.g + a.b * a.b); };
    for (std::size_t i = 0; i < k_resolution.pixels(); ++i) {
      depth_error += std::pow(static_cast<double>(layers.depth[i] - expected.depth[i]), 2);
      albedo_error += squared(layers.albedo[i] - expected.albedo[i]);
      normal_error += squared(layers.normal[i] - expected.normal[i]);
    }
    EXPECT_LT(std::sqrt(depth_error / k_resolution.pixels()), 0.05) << method.label;
    EXPECT_LT(std::sqrt(albedo_error / k_resolution.pixels()), 0.05) << method.label;
    EXPECT_LT(std::sqrt(normal_error / k_resolution.pixels()), 0.15) << method.label;
  }
}

}  // namespace
}  // namespace gradslc
