// `vpl.direct`: light of area emitters comes through VPLs on them (k = 0), whose bounding the gather's ray compensates,
// and that of all other emitters by next-event estimation among these alone. Closed forms, and every method against
// path tracing, part by part: each path that ends on an emitter must be found once.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "expect_unbiased.h"
#include "scene/loaders/loader.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

constexpr double k_false_alarm = 0.001;  // of one TEST
constexpr Resolution k_resolution{32, 32};
constexpr Components k_indirect{.emission = false, .direct = false};
constexpr Components k_direct{.emission = false, .indirect = false};

using Parameters = std::map<std::string, ParameterValue>;

/// Blocks are small: pixels that share random numbers share rare bright paths, whose tail few runs do not show.
std::vector<Method> direct_methods(double light_paths) {
  std::vector<Method> methods = {
      {"vpl", "vpl", {{"selection", "power"}, {"samples", 20.0}}},
      {"slc", "slc", {}},
      {"slc, small bound", "slc", {{"vpl/bound", 0.3}, {"cut_size", 4.0}}},
      {"slc tile", "slc", {{"gather", "tile"}, {"tile/candidates", 128.0}}},
      {"gradslc reconnection", "gradslc", {}},
      {"gradslc random replay", "gradslc", {{"shift", "random_replay"}, {"block/width", 2.0}, {"block/height", 2.0}}},
      {"gradslc block, tile",
       "gradslc",
       {{"shift", "block"}, {"gather", "tile"}, {"tile/size", 8.0}, {"block/width", 2.0}, {"block/height", 2.0}}},
  };
  for (Method& method : methods) {
    method.parameters["vpl/direct"] = true;
    method.parameters["vpl/light_paths"] = light_paths;
  }
  return methods;
}

/// Form factor of a rectangle of a x b, seen from a small parallel one at distance `height` below one of its corners.
double corner_form_factor(double a, double b, double height) {
  const double x = a / height, y = b / height;
  const double root_x = std::sqrt(1 + x * x), root_y = std::sqrt(1 + y * y);
  return (x / root_x * std::atan(y / root_x) + y / root_y * std::atan(x / root_y)) / (2 * k_pi);
}

// The point under a lamp's centre, from far above strength b of connections to far below.
TEST(DirectLightThroughVpls, OfOneLampOverAPlane) {
  constexpr double k_albedo = 0.5, k_width = 0.4, k_depth = 0.2, k_radiance = 2;
  const double heights[] = {0.05, 0.5}, bounds[] = {0, 0.5, 1.5, 30, 1e6};
  const auto levels = sidak(k_false_alarm, std::size(heights) * std::size(bounds) * 4);
  for (const double height : heights) {
    // The camera looks down at the point from halfway to the lamp.
    const Scene scene(load_scene_text(fmt::format(
                                          R"(<scene version="3.0.0">
          <sensor type="perspective"><float name="fov" value="0.1"/>
            <transform name="to_world"><lookat origin="0, {}, 0" target="0, 0, 0" up="0, 0, 1"/></transform></sensor>
          <shape type="rectangle"><transform name="to_world"><scale value="9"/><rotate x="1" angle="-90"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf></shape>
          <shape type="rectangle"><transform name="to_world"><scale x="{}" y="{}"/><rotate x="1" angle="90"/>
              <translate y="{}"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
            <emitter type="area"><rgb name="radiance" value="{}"/></emitter></shape></scene>)",
                                          0.5 * height, k_albedo, k_width / 2, k_depth / 2, height, k_radiance),
                                      "lamp_over_plane.xml", {.width = 8, .height = 8}));
    const double expected = k_albedo * k_radiance * 4 * corner_form_factor(k_width / 2, k_depth / 2, height);
    for (const double bound : bounds)
      for (const Method& method :
           {direct_methods(200)[0], direct_methods(200)[1], direct_methods(200)[3], direct_methods(200)[4]}) {
        Method bounded = method;
        bounded.parameters["vpl/bound"] = bound;
        const std::string label = fmt::format("{}, height {}, bound {}", method.label, height, bound);
        const auto moments = block_moments(bounded, scene, {.max_depth = 2}, {.runs = 48, .passes = 8, .block = 8});
        const Moments& image = moments.blocks.at(Quantity::image)[0];
        EXPECT_GT(image.p_value(expected), levels) << label << ": " << image.mean() << ", expected " << expected;
        EXPECT_LT(image.standard_error(), 0.02 * expected) << label << ": too noisy to tell";
        EXPECT_NEAR(moments.blocks.at(Quantity::direct)[0].mean(), image.mean(), 1e-6 * expected) << label;
      }
  }
}

// A floor under a sky of radiance 1, and a lamp that shines away from it: albedo exactly, beyond the reach of what
// compensates VPLs, and by the sky's share of the power of all emitters without VPLs, which is 1.
TEST(DirectLightThroughVpls, LeavesTheSkyToNextEventEstimation) {
  constexpr double k_albedo = 0.5;
  const Scene scene = open_furnace({16, 16});
  for (const double bound : {0.0, 100.0})
    for (Method method : direct_methods(50)) {
      method.parameters["vpl/bound"] = bound;
      const auto moments =
          block_moments(method, scene, {.max_depth = 3}, {.runs = 40, .passes = 8, .block = 16, .seed = 12});
      const Moments& image = moments.blocks.at(Quantity::image)[0];
      EXPECT_GT(image.p_value(k_albedo), sidak(k_false_alarm, 12)) << method.label << " " << image.mean();
      EXPECT_LT(image.standard_error(), 0.01 * k_albedo) << method.label << ": too noisy to tell";
    }
}

/// False-alarm rate 0.1 % for the whole test.
void expect_furnace(const Components& components, int max_depth) {
  constexpr double k_albedo = 0.5;
  const Scene scene = closed_furnace(Rgb(static_cast<float>(k_albedo)), {16, 16});
  double expected = 0;
  for (int edges = 1; edges <= max_depth; ++edges)
    if (components.includes(edges)) expected += std::pow(k_albedo, edges - 1);
  const std::vector<Method> methods = direct_methods(50);
  for (const Method& method : methods) {
    const auto moments = block_moments(method, scene, {.max_depth = max_depth, .components = components},
                                       {.runs = 160, .passes = 2, .block = 16, .seed = 11});
    const Moments& image = moments.blocks.at(Quantity::image)[0];
    EXPECT_GT(image.p_value(expected), sidak(k_false_alarm, methods.size()))
        << fmt::format("{}: mean {} +- {}, expected {}", method.label, image.mean(), image.standard_error(), expected);
    EXPECT_LT(image.standard_error(), 0.02 * expected) << method.label << ": too noisy to tell";
  }
}

TEST(DirectLightThroughVpls, InAClosedFurnace) { expect_furnace({}, 6); }
TEST(DirectLightThroughVpls, InAClosedFurnaceIndirect) { expect_furnace(k_indirect, 6); }
TEST(DirectLightThroughVpls, InAClosedFurnaceDirect) { expect_furnace(k_direct, 6); }
TEST(DirectLightThroughVpls, InAClosedFurnaceShallowest) { expect_furnace({}, 2); }

TEST(DirectLightThroughVpls, InABoxWithMirrors) {
  expect_unbiased(test_box(k_resolution, {.mirror = true}), {.max_depth = 5}, direct_methods(300));
}
// Behind a mirror, an emitter seen from x is indirect light: D = 3.
TEST(DirectLightThroughVpls, InABoxWithMirrorsIndirect) {
  expect_unbiased(test_box(k_resolution, {.mirror = true}), {.max_depth = 4, .components = k_indirect},
                  direct_methods(300));
}
TEST(DirectLightThroughVpls, OnGloss) {
  expect_unbiased(glossy_box(k_resolution, GlossyLight::lamp), {.max_depth = 4}, direct_methods(1000));
}

constexpr const char* k_gauze = R"(<bsdf type="mask"><float name="opacity" value="0.5"/>
  <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.8, 0.6, 0.4"/></bsdf></bsdf></bsdf>)";
constexpr const char* k_pane =
    R"(<bsdf type="thindielectric"><rgb name="specular_transmittance" value="0.9, 1, 0.8"/></bsdf>)";

TEST(DirectLightThroughVpls, BehindAPane) {
  expect_unbiased(partitioned_box(k_resolution, k_pane), {.max_depth = 5}, direct_methods(500));
}
TEST(DirectLightThroughVpls, BehindGauze) {
  expect_unbiased(partitioned_box(k_resolution, k_gauze), {.max_depth = 5}, direct_methods(500));
}
TEST(DirectLightThroughVpls, BehindGauzeIndirect) {
  expect_unbiased(partitioned_box(k_resolution, k_gauze), {.max_depth = 4, .components = k_indirect},
                  direct_methods(500));
}
TEST(DirectLightThroughVpls, BehindGauzeDirect) {
  // Most connections to the lamp are blocked: more passes, so that rare ones are in every run.
  UnbiasedOptions options;
  options.methods.passes = 16;
  expect_unbiased(partitioned_box(k_resolution, k_gauze), {.max_depth = 4, .components = k_direct}, direct_methods(500),
                  options);
}

// Two lamps of different power that touch walls, a point light and the sky: the former through VPLs, the others by
// next-event estimation among themselves, and the sky also by the ray, which must not be cut before it meets a wall.
void expect_unbiased_beside_other_emitters(const char* board) {
  const std::string text = fmt::format(R"(<scene version="3.0.0">
    <sensor type="perspective"><float name="fov" value="42"/>
      <transform name="to_world"><lookat origin="0, 0, -3.6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
    <bsdf type="diffuse" id="white"><rgb name="reflectance" value="0.7"/></bsdf>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><translate y="-1"/></transform>
      <ref id="white"/></shape>
    <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="180"/><translate z="1"/></transform>
      <ref id="white"/></shape>
    <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="90"/><translate x="-1"/></transform>
      <ref id="white"/></shape>
    <shape type="rectangle">
      <transform name="to_world"><scale value="0.3"/><rotate y="1" angle="215"/><translate x="0.6" y="-0.6" z="0.5"/></transform>
      {}</shape>
    <shape type="rectangle">
      <transform name="to_world"><scale x="0.3" y="0.2"/><rotate x="1" angle="90"/><translate x="-0.7" y="0.6" z="0.3"/></transform>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.4"/></bsdf>
      <emitter type="area"><rgb name="radiance" value="6, 4, 2"/></emitter></shape>
    <shape type="cube">
      <transform name="to_world"><scale value="0.15"/><translate x="0.3" y="-0.84" z="-0.2"/></transform>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.4"/></bsdf>
      <emitter type="area"><rgb name="radiance" value="0.5, 1, 2"/></emitter></shape>
    <emitter type="point"><point name="position" x="0.4" y="0.5" z="-0.4"/><rgb name="intensity" value="0.3"/></emitter>
    <emitter type="constant"><rgb name="radiance" value="0.3, 0.4, 0.5"/></emitter></scene>)",
                                       board);
  const Scene scene(load_scene_text(text, "mixed.xml", {.width = k_resolution.width, .height = k_resolution.height}));
  expect_unbiased(scene, {.max_depth = 4}, direct_methods(500));
}

TEST(DirectLightThroughVpls, BesideOtherEmitters) { expect_unbiased_beside_other_emitters(R"(<ref id="white"/>)"); }
TEST(DirectLightThroughVpls, BesideOtherEmittersAndAMirror) {
  expect_unbiased_beside_other_emitters(R"(<bsdf type="conductor"><string name="material" value="none"/></bsdf>)");
}

}  // namespace
}  // namespace gradslc
