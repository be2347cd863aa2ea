#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

constexpr Resolution k_resolution{21, 11};
const Method k_shifts[] = {{"reconnection", "gpt", {}}, {"random replay", "gpt", {{"shift", "random_replay"}}}};

struct Rendered {
  Film film;
  std::map<std::string, double> counters;
};
Rendered render(const Method& method, const Scene& scene, const RenderSettings& settings, const FilmLayers& layers,
                std::uint32_t passes = 4) {
  const auto integrator = method.make();
  integrator->prepare(scene, settings);
  Rendered rendered{Film(scene.camera().resolution(), layers), {}};
  for (std::uint32_t pass = 0; pass < passes; ++pass) integrator->render_pass(pass, rendered.film);
  for (const auto& [name, value] : integrator->statistics().counters) rendered.counters[name] = value;
  return rendered;
}

double failures(const Rendered& rendered) {
  double sum = 0;
  for (const auto& [name, value] : rendered.counters)
    if (name.starts_with("failed_shifts_")) sum += value;
  return sum;
}

// The base path is path tracing's, to the bit, with and without parts and whether or not differences are kept.
TEST(GradientPathTracing, PrimalIsPathTracings) {
  const Scene scenes[] = {test_box(k_resolution, {.mirror = true}), glossy_box(k_resolution, GlossyLight::sky),
                          glossy_box(k_resolution, GlossyLight::points)};
  for (const Scene& scene : scenes)
    for (const Method& method : k_shifts)
      for (const bool gradients : {false, true})
        for (const bool parts : {false, true}) {
          const RenderSettings settings{.max_depth = 6};
          const Film expected = render({"spt", "spt", {}}, scene, settings, {.parts = parts}).film;
          const Film film = render(method, scene, settings, {.gradients = gradients, .parts = parts}).film;
          EXPECT_EQ(film.primal(), expected.primal()) << method.label;
          for (int part = 0; parts && part < k_part_count; ++part)
            EXPECT_EQ(film.part(static_cast<Part>(part)), expected.part(static_cast<Part>(part))) << method.label;
        }
}

// A floor under a uniform sky: reconnected offsets send the same light from every direction, sample by sample.
TEST(GradientPathTracing, DifferencesVanishSampleBySampleWhereAllVerticesAreAlike) {
  const Scene scene = open_furnace(k_resolution);
  for (const Method& method : k_shifts) {
    const Film film = render(method, scene, {.max_depth = 4}, {.gradients = true}, 1).film;
    for (int y = 0; y < k_resolution.height; ++y)
      for (int x = 0; x < k_resolution.width; ++x) {
        EXPECT_LT(max_channel(film.half(0).dx.mean({x, y})), 1e-6f) << method.label;
        EXPECT_GT(max_channel(film.half(0).dx.mean({x, y})), -1e-6f) << method.label;
        EXPECT_LT(max_channel(film.half(0).dy.mean({x, y})), 1e-6f) << method.label;
        EXPECT_GT(max_channel(film.half(0).dy.mean({x, y})), -1e-6f) << method.label;
      }
  }
}

TEST(GradientPathTracing, RecordsEveryPairOnceAPass) {
  for (const Method& method : k_shifts) {
    const Film film =
        render(method, test_box(k_resolution, {.mirror = true}), {.max_depth = 4}, {.gradients = true}).film;
    for (int y = 0; y < k_resolution.height; ++y)
      for (int x = 0; x < k_resolution.width; ++x) {
        EXPECT_EQ(film.half(0).dx.sets({x, y}), x + 1 < k_resolution.width ? 2u : 0u);
        EXPECT_EQ(film.half(0).dy.sets({x, y}), y + 1 < k_resolution.height ? 2u : 0u);
      }
  }
}

TEST(GradientPathTracing, CountsShiftsAndWhyTheyFail) {
  const FilmLayers gradients{.gradients = true};
  const double pairs = 20 * 11 + 21 * 10, shifts = 2 * pairs * 4;
  const Rendered furnace = render(k_shifts[0], closed_furnace(Rgb(0.5f), k_resolution), {.max_depth = 4}, gradients);
  EXPECT_EQ(furnace.counters.at("shifts"), shifts);
  // Next to an edge of the box, an offset's vertex lies on the wall that its base's next vertex is on.
  EXPECT_LT(failures(furnace), 0.1 * shifts);
  EXPECT_EQ(furnace.counters.at("failed_shifts_occluded"), 0);

  const Rendered box = render(k_shifts[0], test_box(k_resolution, {.mirror = true}), {.max_depth = 4}, gradients);
  EXPECT_GT(box.counters.at("failed_shifts_occluded"), 0);
  EXPECT_GT(box.counters.at("failed_shifts_not_connectable"), 0);  // mirror beside wall
  EXPECT_LT(failures(box), 0.5 * shifts);
  EXPECT_EQ(failures(render(k_shifts[1], test_box(k_resolution), {.max_depth = 4}, gradients)), 0);
}

}  // namespace
}  // namespace gradslc
