// Which differences gradslc records, and what they are where all pixels are alike.

#include <gtest/gtest.h>

#include <vector>

#include "scene/loaders/loader.h"
#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{21, 11};
constexpr std::uint32_t k_passes = 6;

std::vector<Method> every_shift() {
  std::vector<Method> methods;
  for (const char* gather : {"descent", "tile"}) {
    const auto add = [&](const char* shift, std::map<std::string, ParameterValue> more) {
      more.insert({{"gather", gather}, {"shift", shift}, {"vpl/light_paths", 100.0}, {"tile/size", 8.0}});
      methods.push_back({std::string(shift) + ", " + gather, "gradslc", more});
    };
    add("reconnection", {});
    add("reconnection", {{"stencil", "symmetric"}});
    add("random_replay", {});
    add("block", {});
    add("block", {{"block/width", 5.0}, {"block/height", 1.0}});
  }
  return methods;
}

Film render(const Method& method, const Scene& scene, const RenderSettings& settings) {
  const auto integrator = method.make();
  integrator->prepare(scene, settings);
  Film film(scene.camera().resolution(), {.gradients = true});
  for (std::uint32_t pass = 0; pass < k_passes; ++pass) integrator->render_pass(pass, film);
  return film;
}

template <class Body>
void for_each_moments(const Film& film, const Body& body) {
  for (int half = 0; half < 2; ++half)
    for (std::size_t i = 0; i < k_resolution.pixels(); ++i) body(film.half(half), k_resolution.pixel(i));
}

// Counts are the same in scenes that have nothing in common.
TEST(GradientStochasticLightcuts, PairsAreRecordedWhateverIsHit) {
  const Scene boxes = test_box(k_resolution, {.mirror = true}), gloss = glossy_box(k_resolution, GlossyLight::sky),
              open = open_furnace(k_resolution);
  for (const Method& method : every_shift()) {
    const RenderSettings settings{.max_depth = 4};
    const Film a = render(method, boxes, settings), b = render(method, gloss, settings),
               c = render(method, open, settings);
    std::size_t dx = 0, dy = 0;
    for (int half = 0; half < 2; ++half)
      for (std::size_t i = 0; i < k_resolution.pixels(); ++i) {
        const Pixel pixel = k_resolution.pixel(i);
        for (const Film* other : {&b, &c}) {
          EXPECT_EQ(a.half(half).primal.count(pixel), other->half(half).primal.count(pixel)) << method.label;
          EXPECT_EQ(a.half(half).dx.count(pixel), other->half(half).dx.count(pixel)) << method.label;
          EXPECT_EQ(a.half(half).dy.count(pixel), other->half(half).dy.count(pixel)) << method.label;
        }
        dx += a.half(half).dx.count(pixel), dy += a.half(half).dy.count(pixel);
        if (pixel.x + 1 == k_resolution.width) {
          EXPECT_EQ(a.half(half).dx.count(pixel), 0u) << method.label;
        }
        if (pixel.y + 1 == k_resolution.height) {
          EXPECT_EQ(a.half(half).dy.count(pixel), 0u) << method.label;
        }
      }
    EXPECT_GT(dx, 0u) << method.label;
    EXPECT_EQ(dy > 0, !method.parameters.contains("block/height")) << method.label;
  }
}

TEST(GradientStochasticLightcuts, ConstantSceneIsExactToTheLastPixel) {
  const Scene sky(load_scene_text(R"(<scene version="3.0.0">
    <sensor type="perspective"><float name="fov" value="40"/></sensor>
    <emitter type="constant"><rgb name="radiance" value="0.25, 0.5, 1"/></emitter></scene>)",
                                  "sky.xml", {.width = k_resolution.width, .height = k_resolution.height}));
  for (const Method& method : every_shift()) {
    const Film film = render(method, sky, {.max_depth = 4});
    for_each_moments(film, [&](const FilmHalf& half, Pixel pixel) {
      EXPECT_EQ(half.primal.mean(pixel), Rgb(0.25f, 0.5f, 1)) << method.label;
      EXPECT_EQ(half.dx.mean(pixel), Rgb()) << method.label;
      EXPECT_EQ(half.dy.mean(pixel), Rgb()) << method.label;
    });
  }
}

// A floor under a uniform sky: the same numbers choose the same direction for all pixels.
TEST(GradientStochasticLightcuts, DifferencesVanishWhereAllVerticesAreAlike) {
  const Scene scene = open_furnace(k_resolution);
  for (const Method& method : every_shift()) {
    const Film film = render(method, scene, {.max_depth = 2, .components = {.emission = false, .indirect = false}});
    for_each_moments(film, [&](const FilmHalf& half, Pixel pixel) {
      EXPECT_LT(std::abs(half.dx.mean(pixel).g), 2e-6f) << method.label;
      EXPECT_LT(std::abs(half.dy.mean(pixel).g), 2e-6f) << method.label;
    });
  }
}

TEST(GradientStochasticLightcuts, RaysOfTheirOwnDifferWithinABlock) {
  const Scene scene = open_furnace(k_resolution);
  for (const char* gather : {"descent", "tile"}) {
    const Method method{gather, "gradslc", {{"shift", "block"}, {"gather", gather}, {"block/share_rays", false}}};
    const Film film = render(method, scene, {.max_depth = 2, .components = {.emission = false, .indirect = false}});
    int differing = 0;
    for_each_moments(film,
                     [&](const FilmHalf& half, Pixel pixel) { differing += std::abs(half.dx.mean(pixel).g) > 1e-4f; });
    EXPECT_GT(differing, static_cast<int>(k_resolution.pixels()) / 2) << gather;
  }
}

}  // namespace
}  // namespace gradslc
