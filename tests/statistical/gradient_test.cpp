// Gradients: their means on every scene, what replay makes of their variance, and that l2 keeps the mean.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "core/hash.h"
#include "experiments/reconstruct.h"
#include "film/film_io.h"
#include "reconstruction/reconstruction.h"
#include "scene/loaders/loader.h"
#include "support/render/all_scenes.h"
#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

constexpr double k_false_alarm = 0.001;  // of one test

Method gradslc(const char* gather, const char* shift, std::map<std::string, ParameterValue> more = {}) {
  more.insert({{"gather", gather}, {"shift", shift}, {"vpl/light_paths", 1000.0}});
  return {fmt::format("{}, {}", shift, gather), "gradslc", more};
}

/// Every shift and stencil of every integrator with gradients.
std::vector<Method> gradient_methods() {
  std::vector<Method> methods;
  for (const char* gather : {"descent", "tile"}) {
    methods.push_back(gradslc(gather, "reconnection"));
    methods.push_back(gradslc(gather, "reconnection", {{"stencil", "symmetric"}}));
    methods.back().label += ", symmetric";
    methods.push_back(gradslc(gather, "random_replay"));
    methods.push_back(gradslc(gather, "block"));
    methods.push_back(gradslc(gather, "block", {{"block/share_rays", false}}));
    methods.back().label += ", own rays";
  }
  methods.push_back({"gpt", "gpt", {}});
  methods.push_back({"gpt random replay", "gpt", {{"shift", "random_replay"}}});
  return methods;
}

class GradientMeans : public testing::TestWithParam<SceneFile> {};
INSTANTIATE_TEST_SUITE_P(Scenes, GradientMeans, testing::ValuesIn(all_scenes()),
                         [](const auto& entry) { return entry.param.identifier(); });

constexpr int k_side = 24;

/// E[dx](x,y) = E[I(x+1,y)] - E[I(x,y)], E[dy] alike, over blocks of pixels: the right-hand side by path tracing.
void expect_differences_of_means(const Scene& scene) {
  constexpr int k_block = 8, k_runs = 24;
  const RenderSettings settings{.max_depth = 5};
  const BlockMoments reference =
      block_moments({"spt", "spt", {}}, scene, settings, {.runs = k_runs, .passes = 64, .block = k_block, .seed = 31});
  const std::vector<Method> methods = gradient_methods();
  const std::size_t tests = methods.size() * reference.blocks.at(Quantity::dx).size() * 2;
  for (const Method& method : methods) {
    const BlockMoments moments =
        block_moments(method, scene, settings, {.runs = k_runs, .passes = 8, .block = k_block, .seed = 32});
    for (const Quantity quantity : {Quantity::dx, Quantity::dy}) {
      const Comparison c = compare_blocks(moments.blocks.at(quantity), reference.blocks.at(quantity));
      EXPECT_GT(c.p_value, sidak(k_false_alarm, tests))
          << fmt::format("{}, {}: block {} has {} where spt has {}, p = {:.2g}", method.label, to_string(quantity),
                         c.block, c.mean_a, c.mean_b, c.p_value);
    }
  }
}

TEST_P(GradientMeans, AreDifferencesOfPathTracingsMeans) {
  if (!std::filesystem::exists(GetParam().path()))
    GTEST_SKIP() << "the folder of real scenes is not beside the repository: ../shared/scenes";
  expect_differences_of_means(Scene(load_scene(GetParam().path().string(), {.width = k_side, .height = k_side})));
}

// A ball of smooth and one of rough metal, both out of focus, in a room with a lamp.
TEST(GradientMeansThroughALens, AreDifferencesOfPathTracingsMeans) {
  expect_differences_of_means(Scene(load_scene_text(fmt::format(R"(<scene version="3.0.0">
    <sensor type="thinlens"><float name="fov" value="60"/><float name="aperture_radius" value="0.1"/>
      <float name="focus_distance" value="2"/>
      <transform name="to_world"><lookat origin="0, 1, 3" target="0, 0.7, 0" up="0, 1, 0"/></transform>
      <film type="hdrfilm"><integer name="width" value="{0}"/><integer name="height" value="{0}"/></film></sensor>
    <shape type="rectangle"><transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/>
      <translate y="2.5"/></transform><emitter type="area"><rgb name="radiance" value="8"/></emitter></shape>
    <shape type="rectangle"><transform name="to_world"><scale value="4"/><rotate x="1" angle="-90"/></transform>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></shape>
    <shape type="rectangle"><transform name="to_world"><scale value="4"/><translate z="-1"/></transform>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.3, 0.5, 0.7"/></bsdf></shape>
    <shape type="sphere"><point name="center" x="-0.6" y="0.5" z="1"/><float name="radius" value="0.5"/>
      <bsdf type="conductor"/></shape>
    <shape type="sphere"><point name="center" x="0.6" y="0.5" z="0"/><float name="radius" value="0.5"/>
      <bsdf type="roughconductor"><float name="alpha" value="0.3"/></bsdf></shape></scene>)",
                                                                k_side),
                                                    "lens.xml")));
}

Film render(const Method& method, const Scene& scene, const RenderSettings& settings, std::uint32_t passes) {
  const auto integrator = method.make();
  integrator->prepare(scene, settings);
  Film film(scene.camera().resolution(), {.gradients = integrator->traits().gradients});
  for (std::uint32_t pass = 0; pass < passes; ++pass) integrator->render_pass(pass, film);
  return film;
}

/// Median over the pixels of the variance of one sample of dx over that of the primal.
double variance_ratio(const Film& film) {
  const MomentLayers dx = moment_layers(film.half(0).dx, film.half(1).dx),
                     primal = moment_layers(film.half(0).primal, film.half(1).primal);
  const auto of_one = [](const MomentLayers& moment, std::size_t i) {
    return static_cast<double>(luminance(moment.variance[i]) * moment.count[i]);
  };
  std::vector<double> ratios;
  for (std::size_t i = 0; i < primal.count.size(); ++i)
    if (dx.count[i] > 1 && of_one(primal, i) > 0) ratios.push_back(of_one(dx, i) / of_one(primal, i));
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

// Pixels that share VPLs differ by little; those that repeat each other's numbers by half of what independent ones
// would. With other numbers for the choice of VPLs in every other strip of a thousandth of the scene's width,
// random_replay has 1.30 and 1.07 in place of 0.65.
TEST(GradientVariance, SharedNumbersKeepItSmall) {
  constexpr Resolution k_resolution{128, 128};
  const Scene scene = test_box(k_resolution);
  const RenderSettings settings{.max_depth = 5, .components = {.emission = false, .direct = false}};
  for (const char* gather : {"descent", "tile"})
    for (const auto& [shift, most] :
         {std::pair{"random_replay", 0.8}, std::pair{"block", 0.2}, std::pair{"reconnection", 0.2}}) {
      const double ratio = variance_ratio(render(gradslc(gather, shift), scene, settings, 16));
      EXPECT_LT(ratio, most) << shift << ", " << gather;
    }
}

/// Pixel means over independent runs, reconstructed by l2 or, without gradients, as they are.
std::vector<Moments> pixel_moments(const Method& method, const Scene& scene, RenderSettings settings,
                                   std::uint32_t passes, int runs, std::uint64_t seed) {
  std::unique_ptr<Reconstruction> l2;
  for (const ReconstructionEntry& entry : reconstruction_registry())
    if (entry.name == std::string("l2")) l2 = entry.make();
  std::vector<Moments> moments(scene.camera().resolution().pixels());
  for (int run = 0; run < runs; ++run) {
    settings.seed = hash_combine(seed, static_cast<std::uint64_t>(run));
    const Film film = render(method, scene, settings, passes);
    RgbImage image = film.primal();
    if (film.layers().gradients) {
      image = l2->reconstruct(reconstruction_input(film)).image;
    }
    for (std::size_t i = 0; i < moments.size(); ++i) moments[i].add(static_cast<double>(luminance(image[i])));
  }
  return moments;
}

// Every pixel, edges of objects and of the image included.
TEST(L2, KeepsPathTracingsMeanInEveryPixel) {
  constexpr Resolution k_resolution{20, 18};
  const Scene scene = test_box(k_resolution, {.mirror = true});
  const RenderSettings settings{.max_depth = 4};
  const auto reference = pixel_moments({"spt", "spt", {}}, scene, settings, 256, 64, 41);
  const std::vector<Method> methods = gradient_methods();
  for (const Method& method : methods) {
    const Comparison c = compare_blocks(pixel_moments(method, scene, settings, 8, 192, 42), reference);
    EXPECT_GT(c.p_value, sidak(k_false_alarm, methods.size() * reference.size())) << fmt::format(
        "{}: pixel {} has {} where spt has {}, p = {:.2g}", method.label, c.block, c.mean_a, c.mean_b, c.p_value);
  }
}

}  // namespace
}  // namespace gradslc
