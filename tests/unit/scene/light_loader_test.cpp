#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/exr.h"
#include "loader_fixtures.h"
#include "scene/lights/environment_map.h"
#include "scene/lights/sun_sky_map.h"

namespace gradslc {
namespace {

using test::load;
using test::refusal;

constexpr const char* k_legacy = "0.6.0";
constexpr BoundingSphere k_ball{{0, 0, 0}, 1};

const Light& only_light(const SceneDescription& scene, std::string_view kind) {
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights.at(0)->kind(), kind);
  return *scene.lights.at(0);
}

DirectSample direct(const Light& light, Point3 reference) {
  return light.sample_direct(reference, {0.5f, 0.5f}).value();
}

void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-5f) << a.x << " " << a.y << " " << a.z; }

TEST(LightLoader, ReadsEveryLightWithItsDefaults) {
  const SceneDescription scene = load(R"(<emitter type="constant"/><emitter type="point"/><emitter type="spot"/>
    <emitter type="directional"/><emitter type="sun"/><emitter type="sky"/><emitter type="sunsky"/>)");
  ASSERT_EQ(scene.lights.size(), 7u);
  EXPECT_EQ(scene.lights[0]->radiance({0, 1, 0}), Rgb(1));
  EXPECT_EQ(direct(*scene.lights[1], {0, 0, 2}).radiance, Rgb(0.25f));
  EXPECT_EQ(direct(*scene.lights[2], {0, 0, 2}).radiance, Rgb(0.25f));
  EXPECT_EQ(direct(*scene.lights[3], {}).radiance, Rgb(1));
  EXPECT_EQ(direct(*scene.lights[3], {}).wi, (Vec3{0, 0, -1}));
  const char* kinds[] = {"constant", "point", "spot", "directional", "sun", "sky", "sunsky"};
  for (std::size_t i = 0; i < scene.lights.size(); ++i) EXPECT_EQ(scene.lights[i]->kind(), kinds[i]);
}

TEST(LightLoader, ReadsBothDialects) {
  const auto both = [](const char* legacy, const char* modern, std::string_view kind) {
    const SceneDescription a = load(legacy, {}, k_legacy), b = load(modern);
    const Light &x = only_light(a, kind), &y = only_light(b, kind);
    const Rgb power = x.power(k_ball), again = y.power(k_ball);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(power[c], again[c], 1e-5f * power[c]) << kind;
    const Point3 reference{0.3f, 0.2f, 0.4f};
    expect_near(direct(x, reference).wi, direct(y, reference).wi);
    return direct(x, reference);
  };
  both(R"(<emitter type="constant"><spectrum name="radiance" value="1, 2, 3"/><float name="samplingWeight" value="2"/>
       </emitter>)",
       R"(<emitter type="constant"><rgb name="radiance" value="1, 2, 3"/></emitter>)", "constant");
  const DirectSample point = both(
      R"(<emitter type="point"><point name="position" x="1" y="2" z="3"/><rgb name="intensity" value="5 6 7"/></emitter>)",
      R"(<emitter type="point"><transform name="to_world"><translate x="1" y="2" z="3"/></transform>
       <rgb name="intensity" value="5 6 7"/></emitter>)",
      "point");
  EXPECT_EQ(point.position, (Point3{1, 2, 3}));
  const DirectSample spot = both(
      R"(<emitter type="spot"><transform name="toWorld"><lookAt origin="0, 3, 0" target="0, 0, 0" up="0, 0, 1"/></transform>
       <float name="cutoffAngle" value="40"/><float name="beamWidth" value="20"/></emitter>)",
      R"(<emitter type="spot"><transform name="to_world"><lookat origin="0, 3, 0" target="0, 0, 0" up="0, 0, 1"/></transform>
       <float name="cutoff_angle" value="40"/><float name="beam_width" value="20"/></emitter>)",
      "spot");
  EXPECT_EQ(spot.position, (Point3{0, 3, 0}));
  const DirectSample sun =
      both(R"(<emitter type="directional"><vector name="direction" x="0" y="-2" z="0"/></emitter>)",
           R"(<emitter type="directional"><transform name="to_world"><rotate x="1" angle="90"/></transform></emitter>)",
           "directional");
  expect_near(sun.wi, {0, 1, 0});
}

TEST(LightLoader, SpotFallsOffFromThreeQuartersOfItsCutoff) {
  const SceneDescription scene = load(R"(<emitter type="spot"><float name="cutoff_angle" value="40"/></emitter>)");
  const auto at = [&](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return direct(only_light(scene, "spot"),
                  {static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))})
        .radiance.r;
  };
  EXPECT_FLOAT_EQ(at(29.9), 1);
  EXPECT_NEAR(at(35), 0.5f, 1e-4f);
}

/// The direction of the largest radiance of a map.
Vec3 brightest(const Light& light) {
  Vec3 best;
  float most = -1;
  for (int i = 0; i < 512; ++i)
    for (int j = 0; j < 1024; ++j) {
      const double theta = (i + 0.5) * std::numbers::pi / 512, phi = 2 * std::numbers::pi * (j + 0.5) / 1024;
      const Vec3 direction{static_cast<float>(std::sin(theta) * std::cos(phi)),
                           static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
      if (const float now = luminance(light.radiance(direction)); now > most) best = direction, most = now;
    }
  return best;
}

// The direction is that of the world whatever to_world says, and up is +y in 0.6 and +z in 3.
TEST(LightLoader, TheSunStandsInItsDirection) {
  const Vec3 sun = normalize({0.5f, 0.6f, 0.7f});
  const char* direction = R"(name="sun_direction" x="0.5" y="0.6" z="0.7"/>)";
  const char* legacy_direction = R"(<vector name="sunDirection" x="0.5" y="0.6" z="0.7"/>)";
  const char* turn = R"(<transform name="toWorld"><rotate x="1" angle="20"/><rotate z="1" angle="30"/></transform>)";
  const SceneDescription scenes[] = {
      load(fmt::format(R"(<emitter type="sunsky">{}</emitter>)", legacy_direction), {}, k_legacy),
      load(fmt::format(R"(<emitter type="sunsky">{}{}</emitter>)", turn, legacy_direction), {}, k_legacy),
      load(fmt::format(R"(<emitter type="sunsky"><vector {}</emitter>)", direction)),
  };
  for (const SceneDescription& scene : scenes) EXPECT_GT(dot(brightest(only_light(scene, "sunsky")), sun), 0.9998f);
  EXPECT_FALSE(is_black(scenes[0].lights[0]->radiance({-0.9f, 0.3f, -0.3f})));
  EXPECT_TRUE(is_black(scenes[0].lights[0]->radiance(normalize({0.1f, -0.5f, 0.8f}))));
  EXPECT_FALSE(is_black(scenes[2].lights[0]->radiance(normalize({0.1f, -0.5f, 0.8f}))));
  EXPECT_EQ(scenes[2].notes.size(), 1u);  // Mitsuba 3 has another sun
}

TEST(LightLoader, ScalesSunAndSkyApart) {
  const auto integral = [](const char* properties) {
    const SceneDescription scene =
        load(fmt::format(R"(<emitter type="sunsky"><vector name="sunDirection" x="0" y="1" z="0.2"/>{}</emitter>)",
                         properties),
             {}, k_legacy);
    return luminance(scene.lights.at(0)->power(k_ball));
  };
  const float both = integral(""), sky = integral(R"(<float name="sunScale" value="0"/>)"),
              sun = integral(R"(<float name="skyScale" value="0"/>)");
  EXPECT_NEAR(sky + sun, both, 1e-4f * both);
  EXPECT_NEAR(integral(R"(<float name="scale" value="3"/>)"), 3 * both, 1e-4f * both);
  EXPECT_NEAR(integral(R"(<float name="skyScale" value="2"/><float name="sunScale" value="5"/>)"), 2 * sky + 5 * sun,
              1e-3f * both);
}

TEST(LightLoader, ASunWithoutRadiusIsADirectionalLight) {
  for (const char* plugin : {"sun", "sunsky"}) {
    const auto with_radius = [&](const char* scale) {
      return load(fmt::format(R"(<emitter type="{}"><vector name="sunDirection" x="0.6" y="0.8" z="0"/>
        <float name="sunRadiusScale" value="{}"/></emitter>)",
                              plugin, scale),
                  {}, k_legacy);
    };
    const SceneDescription parallel = with_radius("0"), disk = with_radius("5");
    ASSERT_EQ(parallel.lights.at(0)->kind(), "directional");
    ASSERT_EQ(parallel.lights.size(), std::string_view(plugin) == "sun" ? 1u : 2u);
    expect_near(direct(*parallel.lights[0], {}).wi, {0.6f, 0.8f, 0});
    double power = 0;
    for (const LightPtr& light : parallel.lights) power += luminance(light->power(k_ball));
    EXPECT_NEAR(power, luminance(disk.lights.at(0)->power(k_ball)), 2e-3 * power);
  }
}

// Two texels: red over the upper half of the sphere's middle, green below; negative values count as 0.
TEST(LightLoader, ReadsEnvironmentMaps) {
  const test::TemporaryFolder folder;
  RgbImage map({1, 2});
  map(0, 0) = {2, 0, -1};
  map(0, 1) = {0, 4, 0};
  const std::string exr = folder.write("map.exr", "");
  write_exr(exr, {.image = map, .layers = {}, .attributes = {}});
  const SceneDescription scene =
      load(fmt::format(R"(<emitter type="envmap"><string name="filename" value="{}"/><float name="scale" value="3"/>
        <transform name="to_world"><rotate x="1" angle="90"/></transform></emitter>)",
                       exr));
  const Light& light = only_light(scene, "envmap");
  EXPECT_EQ(light.radiance({0, 0, 1}), Rgb(6, 0, 0));  // local +y
  EXPECT_EQ(light.radiance({0, 0, -1}), Rgb(0, 12, 0));
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0], "test.xml:2: 1 texels of the map are negative in a channel: taken as 0");

  const std::string hdr =
      folder.write("map.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n") + "\x80\x40\x20\x82");
  const SceneDescription legacy =
      load(fmt::format(R"(<emitter type="envmap"><string name="filename" value="{}"/></emitter>)", hdr), {}, k_legacy);
  EXPECT_NEAR(only_light(legacy, "envmap").radiance({0, 1, 0}).r, 2, 0.02f);

  RgbImage broken({1, 1}, Rgb(std::numeric_limits<float>::max()));
  write_exr(exr, {.image = broken, .layers = {}, .attributes = {}});
  const std::string refused =
      refusal(fmt::format(R"(<emitter type="envmap"><string name="filename" value="{}"/><float name="scale" value="2"/>
      </emitter>)",
                          exr));
  EXPECT_NE(refused.find("texel (0, 0) of the map is not finite"), std::string::npos) << refused;
}

struct WrongLight {
  const char* emitter;
  const char* error;  // from the element on
};

TEST(LightLoader, RefusesWhatCannotBe) {
  const WrongLight cases[] = {
      {R"(<emitter type="constnt"/>)", "/scene/emitter: unknown emitter \"constnt\"; did you mean \"constant\"?"},
      {R"(<emitter type="constant"><rgb name="radiance" value="1 -1 0"/></emitter>)",
       "/scene/emitter/rgb: radiance must not be negative"},
      {R"(<emitter type="point"><point name="position" value="1 2 3"/><transform name="to_world"/></emitter>)",
       "/scene/emitter/point: give either position or to_world, not both"},
      {R"(<emitter type="point"><point name="position" x="1" y="2"/></emitter>)",
       "/scene/emitter/point: attribute \"z\" is missing"},
      {R"(<emitter type="point"><point name="position" x="1" y="2" z="inf"/></emitter>)",
       "/scene/emitter/point: z must be a number, not \"inf\""},
      {R"(<emitter type="point"><point name="position" value="1 2"/></emitter>)",
       "/scene/emitter/point: \"position\" must be three numbers, not \"1 2\""},
      {R"(<emitter type="spot"><float name="cutoff_angle" value="0"/></emitter>)",
       "/scene/emitter/float: cutoff_angle must be above 0 and at most 180 degrees, not 0"},
      {R"(<emitter type="spot"><float name="beam_width" value="30"/></emitter>)",
       "/scene/emitter/float: beam_width must be from 0 to cutoff_angle (20), not 30"},
      {R"(<emitter type="spot"><texture name="texture" type="bitmap"/></emitter>)",
       "/scene/emitter/texture: emitter \"spot\" has no use for a <texture>"},
      {R"(<emitter type="directional"><vector name="direction" value="0 0 0"/></emitter>)",
       "/scene/emitter/vector: direction must not be zero"},
      {R"(<emitter type="directional"><vector name="direction" value="0 0 1"/><transform name="to_world"/></emitter>)",
       "/scene/emitter/vector: give either direction or to_world, not both"},
      {R"(<emitter type="envmap"/>)", "/scene/emitter: an envmap needs a filename"},
      {R"(<emitter type="envmap"><string name="filename" value="no.exr"/></emitter>)",
       "/scene/emitter/string: file \"no.exr\" does not exist"},
      {R"(<emitter type="sky"><transform name="to_world"><scale x="2"/></transform></emitter>)",
       "/scene/emitter/transform: the emitter's transform must not scale its axes differently"},
      {R"(<emitter type="sky"><float name="turbidity" value="0.5"/></emitter>)",
       "/scene/emitter/float: turbidity must be from 1 to 10, not 0.5"},
      {R"(<emitter type="sky"><float name="stretch" value="3"/></emitter>)",
       "/scene/emitter/float: stretch must be from 1 to 2, not 3"},
      {R"(<emitter type="sky"><rgb name="albedo" value="0.5 1.5 0"/></emitter>)",
       "/scene/emitter/rgb: albedo must not be above 1"},
      {R"(<emitter type="sky"><integer name="resolution" value="1"/></emitter>)",
       "/scene/emitter/integer: resolution must be from 2 to 16384, not 1"},
      {R"(<emitter type="sky"><vector name="sun_direction" value="0 -1 0"/></emitter>)",
       "/scene/emitter/vector: the sun is below the horizon: the model knows no night"},
      {R"(<emitter type="sky"><vector name="sun_direction" value="0 1 0"/><float name="hour" value="3"/></emitter>)",
       "/scene/emitter/float: give either sun_direction or time and place (hour), not both"},
      {R"(<emitter type="sky"><integer name="day" value="31"/><integer name="month" value="2"/></emitter>)",
       "/scene/emitter/integer[1]: there is no date 2010-2-31"},
      {R"(<emitter type="sky"><float name="hour" value="1"/></emitter>)",
       "/scene/emitter: the sun is below the horizon: the model knows no night"},
      {R"(<emitter type="sunsky"><float name="sky_scale" value="-1"/></emitter>)",
       "/scene/emitter/float: sky_scale must not be negative"},
  };
  for (const WrongLight& wrong : cases) {
    const std::string refused = refusal(wrong.emitter);
    EXPECT_EQ(refused.substr(std::min(refused.find("/scene"), refused.size())), wrong.error);
    EXPECT_TRUE(refused.starts_with("test.xml:2:"));
  }
}

}  // namespace
}  // namespace gradslc
