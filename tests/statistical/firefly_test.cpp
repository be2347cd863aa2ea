// No connection with a VPL makes a firefly: with compensation, none makes a pixel of an image of 64 passes brighter
// than 50 times what the reference has nearby. Fixed seeds: a statement about these images. Prints a table: what is
// left is path traced, and its largest pixels stand beside path tracing's own at equal time.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "scene/loaders/loader.h"
#include "support/render/all_scenes.h"
#include "support/render/method.h"

namespace gradslc {
namespace {

constexpr std::uint32_t k_passes = 64;
constexpr float k_limit = 50;

class Fireflies : public testing::TestWithParam<SceneFile> {};
INSTANTIATE_TEST_SUITE_P(Scenes, Fireflies, testing::ValuesIn(all_scenes()),
                         [](const auto& entry) { return entry.param.identifier(); });

struct Rendered {
  Film film;
  double seconds;  ///< CPU
};
Rendered render(const Method& method, const Scene& scene, std::uint32_t passes, std::uint64_t seed) {
  const auto integrator = method.make();
  integrator->prepare(scene, {.seed = seed, .components = {.emission = false, .direct = false}});
  Film film(scene.camera().resolution(), {.parts = true, .debug = true});
  const std::clock_t begin = std::clock();
  for (std::uint32_t pass = 0; pass < passes; ++pass) integrator->render_pass(pass, film);
  return {std::move(film), static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC};
}

/// Largest luminance within 7 x 7 pixels.
Image<float> local_maximum(const RgbImage& image) {
  const Resolution resolution = image.resolution();
  Image<float> largest(resolution, 0);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const Pixel centre = resolution.pixel(i);
    for (int y = -3; y <= 3; ++y)
      for (int x = -3; x <= 3; ++x)
        if (const Pixel pixel{centre.x + x, centre.y + y}; resolution.contains(pixel))
          largest[i] = std::max(largest[i], luminance(image[pixel]));
  }
  return largest;
}

/// The largest of luminances over the local maximum.
template <class Luminance>
float largest_ratio(const Image<float>& local, const Luminance& luminance_of) {
  float largest = 0;
  for (std::size_t i = 0; i < local.size(); ++i)
    if (local[i] > 0) largest = std::max(largest, luminance_of(i) / local[i]);
  return largest;
}

/// The brightest connection with a VPL over what the reference has nearby, in an image of k_passes.
float largest_connection(const Film& film, const Image<float>& local) {
  const DebugImage debug = film.debug();
  return largest_ratio(local, [&](std::size_t i) {
    const Largest& c = debug[i].contribution;
    return c.part == Part::vpl ? c.luminance / k_passes : 0;
  });
}

TEST_P(Fireflies, ComeFromNoConnectionWithAVpl) {
  if (!std::filesystem::exists(GetParam().path()))
    GTEST_SKIP() << "the folder of real scenes is not beside the repository: ../shared/scenes";
  const Scene scene(load_scene(GetParam().path().string(), {.width = 28, .height = 28}));
  const Method path_tracing{"spt", "spt", {}};
  const Method methods[] = {{"slc", "slc", {}}, {"slc tile", "slc", {{"gather", "tile"}}}};
  const Image<float> local = local_maximum(render(methods[1], scene, 192, 31).film.primal());
  for (const Method& method : methods) {
    const auto [film, seconds] = render(method, scene, k_passes, 32);
    const float connection = largest_connection(film, local);
    EXPECT_LT(connection, k_limit) << method.label;

    const RgbImage image = film.primal(), by_vpls = film.part(Part::vpl);
    const float rest = largest_ratio(local, [&](std::size_t i) { return luminance(image[i] - by_vpls[i]); });
    const double pass_seconds = render(path_tracing, scene, 4, 33).seconds / 4;
    const auto spt_passes = static_cast<std::uint32_t>(std::max(1.0, seconds / pass_seconds));
    const RgbImage spt = render(path_tracing, scene, spt_passes, 34).film.primal();
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} |\n", GetParam().label(), method.label, connection, rest,
               largest_ratio(local, [&](std::size_t i) { return luminance(spt[i]); }));
  }
}

// A control: without bounding there are connections far beyond the limit.
TEST(FirefliesControl, AreSeenWhereConnectionsAreNotBounded) {
  const Scene scene(load_scene(all_scenes()[2].path().string(), {.width = 112, .height = 112}));
  const Image<float> local =
      local_maximum(render({"slc tile", "slc", {{"gather", "tile"}}}, scene, 64, 31).film.primal());
  const Method unbounded{"unbounded", "vpl", {{"vpl/bounding", "none"}, {"selection", "uniform"}, {"samples", 1.0}}};
  const Film film = render(unbounded, scene, k_passes, 32).film;
  EXPECT_GT(largest_connection(film, local), k_limit);
}

}  // namespace
}  // namespace gradslc
