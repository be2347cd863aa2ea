#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "scene/camera.h"
#include "scene/loaders/loader.h"
#include "scene_fixtures.h"

namespace gradslc {
namespace {

PerspectiveCamera load_camera(std::string_view type, std::string_view properties, std::string_view version = "3.0.0") {
  return load_scene_text(fmt::format(R"(<scene version="{}"><sensor type="{}"><float name="fov" value="50"/>{}
                                        <film type="hdrfilm"><integer name="width" value="300"/>
                                        <integer name="height" value="200"/></film></sensor></scene>)",
                                     version, type, properties),
                         "lens.xml")
      .camera;
}

std::string refusal(std::string_view type, std::string_view properties) {
  try {
    load_camera(type, properties);
  } catch (const Error& error) {
    return error.message();
  }
  return "accepted";
}

constexpr std::string_view k_lens = R"(<float name="aperture_radius" value="0.25"/>
    <float name="focus_distance" value="4"/>
    <transform name="to_world"><lookat origin="1 2 3" target="2 4 1" up="0 1 0"/></transform>)";

TEST(ThinLens, AllRaysOfAFilmPositionMeetInThePlaneOfFocus) {
  const PerspectiveCamera camera = load_camera("thinlens", k_lens);
  const PerspectiveCamera pinhole = load_camera("perspective", k_lens.substr(k_lens.find("<transform")));
  ASSERT_TRUE(camera.has_lens());
  ASSERT_FALSE(pinhole.has_lens());
  test::Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vec2 film{300 * random.get1(), 200 * random.get1()};
    const Ray middle = pinhole.generate_ray(film);
    const Point3 focus = middle.origin + (4 / dot(middle.direction, camera.forward())) * middle.direction;
    const Ray ray = camera.generate_ray(film, random.get2());
    const Vec3 on_lens = ray.origin - camera.position();
    EXPECT_LE(length(on_lens), 0.25f + 1e-6f);
    EXPECT_NEAR(dot(on_lens, camera.forward()), 0, 1e-6f);
    EXPECT_NEAR(length(ray.direction), 1, 1e-6f);
    EXPECT_NEAR(length(cross(focus - ray.origin, ray.direction)), 0, 1e-5f);
  }
}

TEST(ThinLens, SamplesCoverTheLensUniformly) {
  const PerspectiveCamera camera = load_camera("thinlens", k_lens);
  constexpr int k_grid = 64;
  double mean_square = 0, farthest = 0;
  Vec3 sum;
  for (int y = 0; y < k_grid; ++y)
    for (int x = 0; x < k_grid; ++x) {
      const Vec2 u{(static_cast<float>(x) + 0.5f) / k_grid, (static_cast<float>(y) + 0.5f) / k_grid};
      const Vec3 on_lens = camera.generate_ray({150, 100}, u).origin - camera.position();
      sum = sum + on_lens;
      mean_square += length_squared(on_lens) / (k_grid * k_grid);
      farthest = std::max(farthest, double{length(on_lens)});
    }
  EXPECT_NEAR(length(sum) / (k_grid * k_grid), 0, 1e-4);
  EXPECT_NEAR(mean_square, 0.25 * 0.25 / 2, 1e-4);  // the mean of r^2 over a disk is R^2 / 2
  EXPECT_GT(farthest, 0.24);
}

TEST(ThinLens, APinholeIgnoresTheLensSample) {
  const PerspectiveCamera pinhole = load_camera("perspective", "");
  const Ray a = pinhole.generate_ray({10, 20}, {0, 0}), b = pinhole.generate_ray({10, 20}, {0.9f, 0.3f});
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_FALSE(load_camera("thinlens", R"(<float name="aperture_radius" value="0"/>)").has_lens());
}

TEST(ThinLens, BothDialectsAndDefaults) {
  const ThinLens legacy =
      load_camera("thinlens", R"(<float name="apertureRadius" value="0.5"/><float name="focusDistance" value="3"/>)",
                  "0.6.0")
          .lens();
  EXPECT_EQ(legacy.radius, 0.5f);
  EXPECT_EQ(legacy.focus_distance, 3);
  EXPECT_EQ(load_camera("thinlens", R"(<float name="aperture_radius" value="1"/>)").lens().focus_distance, 10000);
  EXPECT_EQ(refusal("thinlens", ""), "a thinlens sensor needs aperture_radius");
  EXPECT_EQ(refusal("thinlens", R"(<float name="aperture_radius" value="-1"/>)"),
            "aperture_radius must not be negative, is -1");
  EXPECT_EQ(refusal("thinlens", R"(<float name="aperture_radius" value="1"/><float name="focus_distance" value="0"/>)"),
            "focus_distance must be above 0, not 0");
  EXPECT_EQ(refusal("thinlense", ""), "unknown sensor \"thinlense\"; did you mean \"thinlens\"?");
}

}  // namespace
}  // namespace gradslc
