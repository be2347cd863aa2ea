#include "scene/camera.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/loaders/loader.h"

namespace gradslc {
namespace {

PerspectiveCamera load_camera(std::string_view properties, std::string_view film = {}, const LoadOptions& options = {},
                              std::string_view version = "3.0.0") {
  return load_scene_text(fmt::format("<scene version=\"{}\"><sensor type=\"perspective\">\n{}\n<film "
                                     "type=\"hdrfilm\">{}</film></sensor></scene>",
                                     version, properties, film),
                         "camera.xml", options)
      .camera;
}

std::string refusal(std::string_view properties, std::string_view film = {}, const LoadOptions& options = {}) {
  try {
    load_camera(properties, film, options);
  } catch (const Error& error) {
    return error.message();
  }
  return "accepted";
}

constexpr std::string_view k_wide = R"(<integer name="width" value="400"/><integer name="height" value="200"/>)";
constexpr std::string_view k_tall = R"(<integer name="width" value="200"/><integer name="height" value="400"/>)";

/// Tangents of half the horizontal and vertical field of view, from the rays at the film's edges.
Vec2 half_extent(const PerspectiveCamera& camera) {
  const auto [width, height] = camera.resolution();
  const auto tangent = [&](Vec2 film) {
    const float cosine = dot(camera.generate_ray(film).direction, camera.forward());
    return std::sqrt(1 - cosine * cosine) / cosine;
  };
  return {tangent({static_cast<float>(width), static_cast<float>(height) / 2}),
          tangent({static_cast<float>(width) / 2, 0})};
}

void expect_direction(Vec3 actual, Vec3 expected) {
  expected = normalize(expected);
  EXPECT_NEAR(actual.x, expected.x, 1e-6f);
  EXPECT_NEAR(actual.y, expected.y, 1e-6f);
  EXPECT_NEAR(actual.z, expected.z, 1e-6f);
}

TEST(PerspectiveCamera, LooksAlongZWithXToTheLeft) {
  const PerspectiveCamera camera = load_camera(R"(<float name="fov" value="90"/>)", k_wide);
  expect_direction(camera.generate_ray({200, 100}).direction, {0, 0, 1});
  expect_direction(camera.generate_ray({0, 100}).direction, {1, 0, 1});
  expect_direction(camera.generate_ray({400, 100}).direction, {-1, 0, 1});
  expect_direction(camera.generate_ray({200, 0}).direction, {0, 0.5f, 1});
  expect_direction(camera.generate_ray({400, 200}).direction, {-1, -0.5f, 1});
  EXPECT_EQ(camera.generate_ray({1, 2}).origin, (Point3{0, 0, 0}));
}

TEST(PerspectiveCamera, LookAtShowsTheTargetInTheMiddleAndUpAbove) {
  const PerspectiveCamera camera = load_camera(
      R"(<float name="fov" value="90"/><transform name="to_world"><lookat origin="1 2 3" target="5 2 3" up="0 0 1"/></transform>)",
      k_wide);
  EXPECT_EQ(camera.position(), (Point3{1, 2, 3}));
  expect_direction(camera.generate_ray({200, 100}).direction, {1, 0, 0});
  expect_direction(camera.generate_ray({200, 0}).direction, {1, 0, 0.5f});
  expect_direction(camera.generate_ray({400, 100}).direction, {1, -1, 0});  // z up, looking along x: right is -y
}

TEST(PerspectiveCamera, AMirroringTransformMirrorsTheImage) {
  const PerspectiveCamera camera =
      load_camera(R"(<float name="fov" value="90"/><transform name="to_world"><scale x="-1"/></transform>)", k_wide);
  expect_direction(camera.generate_ray({0, 100}).direction, {-1, 0, 1});
  expect_direction(camera.generate_ray({200, 0}).direction, {0, 0.5f, 1});
}

TEST(PerspectiveCamera, UniformScaleOfTheTransformHasNoEffect) {
  const PerspectiveCamera camera = load_camera(
      R"(<float name="fov" value="90"/><transform name="to_world"><scale value="20"/></transform>)", k_wide);
  expect_direction(camera.generate_ray({0, 100}).direction, {1, 0, 1});
}

TEST(PerspectiveCamera, FovMayMeanAnyAxis) {
  const auto extent = [](const char* axis, std::string_view film) {
    return half_extent(
        load_camera(fmt::format(R"(<float name="fov" value="60"/><string name="fov_axis" value="{}"/>)", axis), film));
  };
  const float tangent = std::tan(k_pi / 6);
  const auto expect = [](Vec2 actual, float x, float y) {
    EXPECT_NEAR(actual.x, x, 1e-5f);
    EXPECT_NEAR(actual.y, y, 1e-5f);
  };
  expect(half_extent(load_camera(R"(<float name="fov" value="60"/>)", k_wide)), tangent, tangent / 2);
  expect(extent("x", k_wide), tangent, tangent / 2);
  expect(extent("y", k_wide), 2 * tangent, tangent);
  expect(extent("smaller", k_wide), 2 * tangent, tangent);
  expect(extent("larger", k_wide), tangent, tangent / 2);
  expect(extent("smaller", k_tall), tangent, 2 * tangent);
  expect(extent("larger", k_tall), tangent / 2, tangent);
  const Vec2 diagonal = extent("diagonal", k_wide);
  expect(diagonal, 2 * tangent / std::sqrt(5.0f), tangent / std::sqrt(5.0f));
  expect(half_extent(
             load_camera(R"(<float name="fov" value="60"/><string name="fovAxis" value="y"/>)", k_wide, {}, "0.6.0")),
         2 * tangent, tangent);
}

TEST(PerspectiveCamera, FocalLengthIsThatOfA35MillimetreCamera) {
  const Vec2 extent =
      half_extent(load_camera(R"(<string name="focal_length" value="50mm"/>)",
                              R"(<integer name="width" value="360"/><integer name="height" value="240"/>)"));
  EXPECT_NEAR(extent.x, 18.0f / 50, 1e-5f);
  EXPECT_NEAR(extent.y, 12.0f / 50, 1e-5f);
}

TEST(PerspectiveCamera, FocalLengthIs50MillimetresWhereNothingIsSaid) {
  const Vec2 extent =
      half_extent(load_camera("", R"(<integer name="width" value="360"/><integer name="height" value="240"/>)"));
  EXPECT_NEAR(extent.x, 18.0f / 50, 1e-5f);
}

TEST(PerspectiveCamera, ACropIsTheMatchingPartOfTheWholeImage) {
  constexpr std::string_view k_crop =
      R"(<integer name="crop_offset_x" value="100"/><integer name="crop_offset_y" value="40"/>
         <integer name="crop_width" value="50"/><integer name="crop_height" value="60"/>)";
  for (const char* axis : {"x", "y", "diagonal", "smaller", "larger"}) {
    const std::string fov = fmt::format(
        R"(<float name="fov" value="60"/><string name="fov_axis" value="{}"/>
           <float name="principal_point_offset_x" value="0.1"/><float name="principal_point_offset_y" value="-0.3"/>)",
        axis);
    const PerspectiveCamera whole = load_camera(fov, k_wide);
    const PerspectiveCamera crop = load_camera(fov, std::string(k_wide).append(k_crop));
    EXPECT_EQ(crop.resolution(), (Resolution{50, 60}));
    for (const Vec2 p : {Vec2{0, 0}, {50, 60}, {12.25f, 31.5f}})
      expect_direction(crop.generate_ray(p).direction, whole.generate_ray(p + Vec2{100, 40}).direction);
  }
}

TEST(PerspectiveCamera, ACropScalesWithAFilmWhoseSizeIsOverridden) {
  constexpr std::string_view k_crop =
      R"(<integer name="crop_offset_x" value="100"/><integer name="crop_offset_y" value="40"/>
         <integer name="crop_width" value="50"/><integer name="crop_height" value="60"/>)";
  LoadOptions options;
  const auto crop = [&](int width) {
    options.width = width;
    return load_camera(R"(<float name="fov" value="60"/>)", std::string(k_wide).append(k_crop), options);
  };
  EXPECT_EQ(crop(800).resolution(), (Resolution{100, 120}));
  EXPECT_EQ(crop(1).resolution(), (Resolution{1, 1}));
  const PerspectiveCamera whole = load_camera(R"(<float name="fov" value="60"/>)", k_wide);
  expect_direction(crop(800).generate_ray({0, 120}).direction, whole.generate_ray({100, 100}).direction);
}

// Mitsuba: the ray of a film position is that of the position plus the offset times the film's size.
TEST(PerspectiveCamera, ThePrincipalPointMovesTheImage) {
  constexpr std::string_view k_fov = R"(<float name="fov" value="90"/>)";
  const PerspectiveCamera moved =
      load_camera(std::string(k_fov) + R"(<float name="principal_point_offset_x" value="0.25"/>
                                          <float name="principal_point_offset_y" value="0.5"/>)",
                  k_wide);
  const PerspectiveCamera centred = load_camera(k_fov, k_wide);
  expect_direction(moved.generate_ray({0, 0}).direction, centred.generate_ray({100, 100}).direction);
  expect_direction(moved.generate_ray({100, 0}).direction, {0, 0, 1});
}

TEST(PerspectiveCamera, FilmsAreKnownByTheirSizes) {
  for (const char* film : {"hdrfilm", "ldrfilm", "mfilm"}) {
    const SceneDescription scene =
        load_scene_text(fmt::format(R"(<scene version="3.0.0"><sensor type="perspective"><film type="{}">{}
                       <rfilter type="box"/></film></sensor></scene>)",
                                    film, k_wide),
                        "camera.xml");
    EXPECT_EQ(scene.camera.resolution(), (Resolution{400, 200})) << film;
    EXPECT_TRUE(scene.notes.empty()) << film;
  }
  const SceneDescription tent = load_scene_text(
      R"(<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm">
         <rfilter type="tent"/></film></sensor></scene>)",
      "camera.xml");
  EXPECT_EQ(tent.notes.size(), 1u);
}

TEST(PerspectiveCamera, SizeMayBeOverridden) {
  const auto size = [](std::optional<int> width, std::optional<int> height) {
    LoadOptions options;
    options.width = width, options.height = height;
    return load_camera(R"(<float name="fov" value="60"/>)", k_wide, options).resolution();
  };
  EXPECT_EQ(size({}, {}), (Resolution{400, 200}));
  EXPECT_EQ(size(100, {}), (Resolution{100, 50}));
  EXPECT_EQ(size({}, 100), (Resolution{200, 100}));
  EXPECT_EQ(size(64, 64), (Resolution{64, 64}));
  EXPECT_EQ(size(1, {}), (Resolution{1, 1}));
  EXPECT_EQ(load_camera(R"(<float name="fov" value="60"/>)").resolution(), (Resolution{768, 576}));
}

TEST(PerspectiveCamera, RefusesWhatItCannotShow) {
  constexpr std::string_view k_fov = R"(<float name="fov" value="60"/>)";
  const auto with = [&](std::string_view more) { return refusal(std::string(k_fov).append(more)); };
  EXPECT_EQ(with(""), "accepted");
  EXPECT_EQ(with(R"(<float name="near_clip" value="1"/><float name="far_clip" value="5"/>)"), "accepted");
  EXPECT_EQ(with(R"(<float name="principal_point_offset_x" value="0"/>)"), "accepted");
  EXPECT_EQ(with(R"(<string name="fov_axis" value="z"/>)"),
            "unknown fov_axis \"z\"; known: x, y, diagonal, smaller, larger");
  EXPECT_EQ(with(R"(<transform name="to_world"><scale x="2"/></transform>)"),
            "the sensor's transform must not scale its axes differently");
  EXPECT_EQ(with(R"(<transform name="to_world"><scale value="0"/></transform>)"),
            "the sensor's transform must not scale its axes differently");
  EXPECT_EQ(with(R"(<transform name="to_world"><matrix value="1 0.6 0  0 0.8 0  0 0 1"/></transform>)"),
            "the sensor's transform must not shear");
  EXPECT_EQ(with(R"(<string name="focal_length" value="50mm"/>)"), "give either fov or focal_length, not both");
  EXPECT_EQ(refusal(R"(<float name="fov" value="180"/>)"), "fov must be above 0 and below 180 degrees, not 180");
  EXPECT_EQ(refusal(k_fov, R"(<integer name="width" value="0"/>)"), "film width must be from 1 to 65536, not 0");
  EXPECT_EQ(refusal(k_fov, R"(<integer name="height" value="2000000000"/>)"),
            "film height must be from 1 to 65536, not 2000000000");
  EXPECT_EQ(refusal(k_fov, R"(<integer name="height" value="20000000000"/>)"),
            "\"height\" must be an integer, not \"20000000000\"");
  EXPECT_EQ(refusal(k_fov, R"(<integer name="crop_width" value="768"/><integer name="crop_offset_x" value="0"/>)"),
            "accepted");
  EXPECT_EQ(refusal(k_fov, R"(<integer name="crop_width" value="100"/>)"), "accepted");
  EXPECT_EQ(refusal(k_fov, R"(<integer name="crop_width" value="769"/>)"),
            "crop_width must be from 1 to 768, the rest of the film, not 769");
  EXPECT_EQ(refusal(k_fov, R"(<integer name="crop_offset_y" value="500"/><integer name="crop_height" value="77"/>)"),
            "crop_height must be from 1 to 76, the rest of the film, not 77");
  EXPECT_EQ(refusal(k_fov, R"(<integer name="crop_offset_x" value="-1"/>)"),
            "crop_offset_x must be from 0 to 767, not -1");
  LoadOptions options;
  options.width = 0;
  EXPECT_EQ(refusal(k_fov, {}, options), "the image's width and height must be from 1 to 65536, not 0");
}

}  // namespace
}  // namespace gradslc
