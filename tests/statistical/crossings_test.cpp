// Straight transmission (thin panes, masks) lets shadow rays and VPL connections pass, counts as an edge of the path
// and is no scattering event (DESIGN 2): closed forms, an oracle that does without crossings, and every method against
// path tracing, part by part.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "expect_unbiased.h"
#include "scene/loaders/loader.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

constexpr double k_false_alarm = 0.001;  // of one TEST
constexpr Resolution k_resolution{32, 32};
const Method k_path_tracing{"spt", "spt", {}};
constexpr Components k_indirect{.emission = false, .direct = false};

constexpr const char* k_pane =
    R"(<bsdf type="thindielectric"><rgb name="specular_transmittance" value="0.9, 1, 0.8"/></bsdf>)";
constexpr const char* k_gauze = R"(<bsdf type="mask"><float name="opacity" value="0.5"/>
  <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.8, 0.6, 0.4"/></bsdf></bsdf></bsdf>)";

/// Blocks and tiles are small: pixels that share random numbers share rare bright paths, whose tail few runs do not
/// show.
const std::vector<Method>& methods() {
  static const std::vector<Method> k_methods = {
      {"vpl", "vpl", {{"vpl/light_paths", 200.0}, {"selection", "power"}, {"samples", 20.0}}},
      {"slc", "slc", {{"vpl/light_paths", 500.0}}},
      {"slc, small bound", "slc", {{"vpl/light_paths", 300.0}, {"vpl/bound", 0.3}, {"cut_size", 4.0}}},
      {"slc tile", "slc", {{"gather", "tile"}, {"vpl/light_paths", 500.0}}},
      {"gradslc reconnection", "gradslc", {{"vpl/light_paths", 500.0}}},
      {"gradslc random replay",
       "gradslc",
       {{"vpl/light_paths", 500.0}, {"shift", "random_replay"}, {"block/width", 2.0}, {"block/height", 2.0}}},
      {"gradslc block",
       "gradslc",
       {{"vpl/light_paths", 500.0}, {"shift", "block"}, {"block/width", 3.0}, {"block/height", 2.0}}},
      {"gradslc block, tile",
       "gradslc",
       {{"vpl/light_paths", 500.0},
        {"shift", "block"},
        {"gather", "tile"},
        {"tile/size", 8.0},
        {"block/width", 2.0},
        {"block/height", 2.0}}},
      {"gradslc reconnection, tile", "gradslc", {{"vpl/light_paths", 500.0}, {"gather", "tile"}, {"tile/size", 8.0}}},
      {"gradslc symmetric, tile",
       "gradslc",
       {{"vpl/light_paths", 500.0}, {"gather", "tile"}, {"tile/size", 8.0}, {"stencil", "symmetric"}}},
      {"gradslc random replay, tile",
       "gradslc",
       {{"vpl/light_paths", 500.0}, {"gather", "tile"}, {"tile/size", 3.0}, {"shift", "random_replay"}}},
      {"gpt", "gpt", {}},
      {"gpt random replay", "gpt", {{"shift", "random_replay"}}},
  };
  return k_methods;
}

const Method& labelled(const std::string& label) {
  return *std::find_if(methods().begin(), methods().end(), [&](const Method& m) { return m.label == label; });
}

// A grey floor in a box of gauze that lets 0.6 pass, under a sky of radiance 1: next-event estimation from the floor
// crosses it once, D = 3; the camera inside sees the floor without a crossing, one outside with one more. What the
// gauze reflects on its inner side stays inside: it has an albedo of `inner_albedo` there, and brings light with D
// >= 4.
Scene gauze_tent(bool camera_outside, double inner_albedo) {
  const std::string text = fmt::format(
      R"(<scene version="3.0.0">
    <sensor type="perspective"><float name="fov" value="{}"/>
      <transform name="to_world"><lookat origin="0, {}, 0" target="0, 0, 0" up="0, 0, 1"/></transform></sensor>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/></transform>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>
    <shape type="cube"><boolean name="flip_normals" value="true"/>
      <transform name="to_world"><scale value="2"/></transform>
      <bsdf type="mask"><float name="opacity" value="0.4"/>
        <bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf></bsdf></shape>
    <emitter type="constant"><rgb name="radiance" value="1"/></emitter></scene>)",
      camera_outside ? 10 : 40, camera_outside ? 8 : 1.5, inner_albedo);
  return Scene(load_scene_text(text, "gauze_tent.xml", {.width = 8, .height = 8}));
}

TEST(Crossings, CountAsEdgesAndTakeTheirShareOnce) {
  constexpr double k_albedo = 0.5, k_transmittance = 0.6;
  struct Case {
    bool camera_outside;
    int max_depth;
    Components components;
    double expected;
    double inner_albedo = 0;
  };
  const double one = k_albedo * k_transmittance, two = one * k_transmittance;
  const Case cases[] = {
      {false, 2, {}, 0},
      {false, 3, {}, one},
      {false, 6, {}, one},
      {false, 3, k_indirect, one},
      {false, 6, {.emission = false, .direct = true, .indirect = false}, 0},
      {true, 3, {}, 0},
      {true, 4, {}, two},
      {true, 6, k_indirect, two},
      // Paths pass with probability 0.6 / (0.6 + 0.4), which the weights of both techniques have to know.
      {false, 3, {}, one, 1},
      {false, 3, k_indirect, one, 1},
  };
  for (const Case& c : cases)
    for (const Method& method : {k_path_tracing, labelled("slc"), labelled("gradslc reconnection"), labelled("gpt")}) {
      const std::string label =
          fmt::format("{}, camera {}, depth {}", method.label, c.camera_outside ? "outside" : "inside", c.max_depth);
      const auto moments = block_moments(method, gauze_tent(c.camera_outside, c.inner_albedo),
                                         {.max_depth = c.max_depth, .components = c.components},
                                         {.runs = 40, .passes = 8, .block = 8, .seed = 9});
      const Moments& image = moments.blocks.at(Quantity::image)[0];
      if (c.expected == 0) {
        EXPECT_EQ(image.mean(), 0) << label;
        continue;
      }
      EXPECT_GT(image.p_value(c.expected), sidak(k_false_alarm, 4 * std::size(cases))) << label << " " << image.mean();
      EXPECT_LT(image.standard_error(), 0.01 * c.expected) << label << ": too noisy to tell";
      // To either camera the floor is x, and the sky its next vertex that scatters.
      EXPECT_NEAR(moments.blocks.at(Quantity::direct)[0].mean(), image.mean(), 1e-6) << label;
    }
}

TEST(Crossings, BehindAPane) { expect_unbiased(partitioned_box(k_resolution, k_pane), {.max_depth = 6}, methods()); }
TEST(Crossings, BehindAPaneIndirect) {
  expect_unbiased(partitioned_box(k_resolution, k_pane), {.max_depth = 5, .components = k_indirect}, methods());
}
TEST(Crossings, BehindGauze) { expect_unbiased(partitioned_box(k_resolution, k_gauze), {.max_depth = 6}, methods()); }
TEST(Crossings, BehindGauzeShallowestIndirect) {
  expect_unbiased(partitioned_box(k_resolution, k_gauze), {.max_depth = 3, .components = k_indirect}, methods());
}
TEST(Crossings, BehindGauzeDirect) {
  expect_unbiased(partitioned_box(k_resolution, k_gauze),
                  {.max_depth = 3, .components = {.emission = true, .direct = true, .indirect = false}}, methods());
}

// Index-matched glass transmits straight, too, but is a delta lobe: shadow rays stop at it, and paths find what is
// behind by sampling it. It makes the same image, edge for edge, without a crossing.
struct Pair {
  const char *crossing, *lobe;
};
constexpr Pair k_pairs[] = {
    {R"(<bsdf type="mask"><rgb name="opacity" value="0.2, 0.4, 0.7"/>
          <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf></bsdf>)",
     R"(<bsdf type="dielectric"><float name="int_ior" value="1"/><float name="ext_ior" value="1"/>
          <rgb name="specular_transmittance" value="0.8, 0.6, 0.3"/></bsdf>)"},
    {R"(<bsdf type="mask"><float name="opacity" value="0.7"/>
          <bsdf type="diffuse"><rgb name="reflectance" value="0.8, 0.5, 0.4"/></bsdf></bsdf>)",
     R"(<bsdf type="blendbsdf"><float name="weight" value="0.7"/>
          <bsdf type="dielectric"><float name="int_ior" value="1"/><float name="ext_ior" value="1"/></bsdf>
          <bsdf type="diffuse"><rgb name="reflectance" value="0.8, 0.5, 0.4"/></bsdf></bsdf>)"},
    {R"(<bsdf type="mask"><float name="opacity" value="0.6"/>
          <bsdf type="conductor"><string name="material" value="none"/></bsdf></bsdf>)",
     R"(<bsdf type="blendbsdf"><float name="weight" value="0.6"/>
          <bsdf type="dielectric"><float name="int_ior" value="1"/><float name="ext_ior" value="1"/></bsdf>
          <bsdf type="conductor"><string name="material" value="none"/></bsdf></bsdf>)"},
};

void expect_same_image(const RenderSettings& settings) {
  for (const Pair& pair : k_pairs) {
    const Scene crossing = partitioned_box(k_resolution, pair.crossing),
                lobe = partitioned_box(k_resolution, pair.lobe);
    ASSERT_TRUE(crossing.has_crossings() && !lobe.has_crossings());
    const auto by_crossing =
        block_moments(k_path_tracing, crossing, settings, {.runs = 32, .passes = 16, .block = 8, .seed = 7});
    const auto by_lobe =
        block_moments(k_path_tracing, lobe, settings, {.runs = 32, .passes = 48, .block = 8, .seed = 8});
    const Comparison c = compare_blocks(by_crossing.blocks.at(Quantity::image), by_lobe.blocks.at(Quantity::image));
    EXPECT_GT(c.p_value, sidak(k_false_alarm, std::size(k_pairs) * c.tests))
        << pair.crossing << ": block " << c.block << " has " << c.mean_a << ", without crossings " << c.mean_b;
  }
}

TEST(Crossings, MakeTheImageOfSampledTransmission) { expect_same_image({.max_depth = 6}); }
TEST(Crossings, MakeTheImageOfSampledTransmissionIndirect) {
  expect_same_image({.max_depth = 4, .components = k_indirect});
}

// With max_bounces both sides cut the same paths: the bound must not be seen.
TEST(Crossings, TruncationIsTheSameForVplsAndCompensation) {
  const Scene scene = partitioned_box(k_resolution, k_gauze);
  const RenderSettings settings{.max_depth = 7, .components = k_indirect};
  const auto slc = [&](double bound, std::uint64_t seed) {
    return block_moments({"", "slc", {{"vpl/light_paths", 500.0}, {"vpl/max_bounces", 2.0}, {"vpl/bound", bound}}},
                         scene, settings, {.runs = 32, .passes = 8, .block = 8, .seed = seed});
  };
  const auto small = slc(0.05, 1), large = slc(2, 2);
  const Comparison c = compare_blocks(small.blocks.at(Quantity::image), large.blocks.at(Quantity::image));
  EXPECT_GT(c.p_value, sidak(k_false_alarm, c.tests)) << c.block << ": " << c.mean_a << " and " << c.mean_b;
}

}  // namespace
}  // namespace gradslc
