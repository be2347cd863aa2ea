// Path tracing agrees with another renderer's images of the Cornell box (DESIGN; the references' README).

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/exr.h"
#include "core/hash.h"
#include "scene/loaders/loader.h"
#include "support/render/method.h"

namespace gradslc {
namespace {

const std::filesystem::path k_shared = GRADSLC_SHARED_DIR;
constexpr int k_block = 16, k_runs = 8;

/// Means over blocks of one channel-averaged image.
std::vector<double> block_means(const RgbImage& image) {
  std::vector<double> means;
  for (int y0 = 0; y0 < image.height(); y0 += k_block)
    for (int x0 = 0; x0 < image.width(); x0 += k_block) {
      double sum = 0;
      for (int y = y0; y < y0 + k_block; ++y)
        for (int x = x0; x < x0 + k_block; ++x) sum += static_cast<double>(luminance(image(x, y)));
      means.push_back(sum / (k_block * k_block));
    }
  return means;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// Mean square over the 3x3 blocks around `i`: the local noise of a reference, from its two halves.
double local_variance(const std::vector<double>& a, const std::vector<double>& b, int columns, std::size_t i) {
  const int rows = static_cast<int>(a.size()) / columns, x = static_cast<int>(i) % columns,
            y = static_cast<int>(i) / columns;
  double sum = 0;
  int n = 0;
  for (int v = std::max(0, y - 1); v <= std::min(rows - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(columns - 1, x + 1); ++u) {
      const auto k = static_cast<std::size_t>(v * columns + u);
      sum += (a[k] - b[k]) * (a[k] - b[k]) / 4, ++n;
    }
  return sum / n;
}

struct Lit {
  std::string name;
  int max_depth;
  Components components;
  const char* plus;   ///< reference image
  const char* minus;  ///< subtracted from it, or null
};

class CornellBox : public testing::TestWithParam<Lit> {};
INSTANTIATE_TEST_SUITE_P(
    Reference, CornellBox,
    testing::Values(
        Lit{"all", 8, {}, "cornell-box-depth8", nullptr}, Lit{"direct", 2, {}, "cornell-box-depth2", nullptr},
        Lit{"indirect", 8, {.emission = false, .direct = false}, "cornell-box-depth8", "cornell-box-depth2"}),
    [](const auto& entry) { return entry.param.name; });

TEST_P(CornellBox, PathTracingMatchesMitsuba) {
  const std::filesystem::path scene_file = k_shared / "scenes/cornell-box/scene_v0.6.xml";
  if (!std::filesystem::exists(scene_file))
    GTEST_SKIP() << "the folder of real scenes is not beside the repository: ../shared/scenes";
  const Scene scene(load_scene(scene_file.string(), {.width = 256, .height = 256}));

  const auto reference_half = [&](const char* half) {
    const auto read = [&](const char* name) {
      return read_exr(k_shared / "references" / fmt::format("{}-{}.exr", name, half)).image;
    };
    RgbImage image = read(GetParam().plus);
    if (!GetParam().minus) return block_means(image);
    const RgbImage subtracted = read(GetParam().minus);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = image[i] - subtracted[i];
    return block_means(image);
  };
  const std::vector<double> a = reference_half("a"), b = reference_half("b");

  std::vector<Moments> ours(a.size());
  for (int run = 0; run < k_runs; ++run) {
    const auto integrator = Method{"spt", "spt", {}}.make();
    integrator->prepare(scene, {.seed = hash_combine(77, static_cast<std::uint64_t>(run)),
                                .max_depth = GetParam().max_depth,
                                .components = GetParam().components});
    Film film(scene.camera().resolution(), {});
    for (std::uint32_t pass = 0; pass < 8; ++pass) integrator->render_pass(pass, film);
    const std::vector<double> means = block_means(film.primal());
    for (std::size_t i = 0; i < means.size(); ++i) ours[i].add(means[i]);
  }

  double our_mean = 0;
  for (const Moments& m : ours) our_mean += m.mean() / static_cast<double>(ours.size());
  const double reference_mean = (mean_of(a) + mean_of(b)) / 2;
  EXPECT_NEAR(our_mean / reference_mean, 1, 0.005);
  RecordProperty("mean_ratio", fmt::format("{:.5f}", our_mean / reference_mean));

  // z of 256 blocks from 8 runs each (Student's t with 7 degrees beside the reference's own noise): 1 % are expected
  // beyond 3.5, none beyond 12 (probability 6e-6 each).
  int beyond = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (ours[i].mean() == 0 && a[i] == 0 && b[i] == 0) continue;  // nothing there for either
    const double variance = ours[i].standard_error() * ours[i].standard_error() + local_variance(a, b, 16, i);
    const double z = (ours[i].mean() - (a[i] + b[i]) / 2) / std::sqrt(variance);
    if (std::abs(z) > 3.5) ++beyond;
    EXPECT_LT(std::abs(z), 12) << fmt::format("block {}: {} where Mitsuba has {}", i, ours[i].mean(),
                                              (a[i] + b[i]) / 2);
  }
  EXPECT_LE(beyond, 8)
      << "blocks that differ beyond their noise";  // binomial(256, 0.01): more than 8 in 0.1 % of cases
  fmt::print("mean ratio {:.5f}, {} of {} blocks beyond z = 3.5\n", our_mean / reference_mean, beyond, ours.size());
}

}  // namespace
}  // namespace gradslc
