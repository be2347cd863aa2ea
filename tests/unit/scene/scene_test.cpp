#include "scene/scene.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "scene_fixtures.h"

namespace gradslc {
namespace {

TriangleMesh triangle() {
  TriangleMesh mesh;
  mesh.name = "three corners";
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

SurfacePoint hit_at(const Scene& scene, float x, float y) {
  const auto hit = scene.intersect({{x, y, 1}, {0, 0, -1}});
  EXPECT_TRUE(hit);
  return hit.value_or(SurfacePoint());
}

TEST(Intersect, InterpolatesPositionAndUv) {
  TriangleMesh mesh = triangle();
  mesh.uvs = {{0, 0}, {1, 0}, {0, 8}};
  const Scene scene(test::describe({mesh}));
  const SurfacePoint hit = hit_at(scene, 0.5f, 1);
  EXPECT_NEAR(hit.position.x, 0.5f, 1e-5f);
  EXPECT_NEAR(hit.position.y, 1, 1e-5f);
  EXPECT_EQ(hit.position.z, 0);
  EXPECT_NEAR(hit.uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(hit.uv.y, 2, 1e-6f);
  EXPECT_EQ(hit.geometric_normal, (Normal3{0, 0, 1}));
  EXPECT_EQ(hit.mesh, 0u);
  EXPECT_EQ(hit.triangle, 0u);
  EXPECT_GT(hit.error, 0);
  EXPECT_LT(hit.error, 1e-5f);
}

TEST(Intersect, WithoutUvsGivesBarycentricCoordinates) {
  const SurfacePoint hit = hit_at(Scene(test::describe({triangle()})), 0.5f, 1);
  EXPECT_NEAR(hit.uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(hit.uv.y, 0.25f, 1e-6f);
  EXPECT_EQ(hit.shading.s, (Vec3{1, 0, 0}));
}

TEST(Intersect, TheTangentPointsToWhereUGrows) {
  TriangleMesh mesh = triangle();
  for (const bool mirrored : {false, true}) {
    mesh.uvs = {{0, 0}, {0, 1}, {mirrored ? -3.0f : 3.0f, 0}};  // u grows along +y or -y
    const SurfacePoint hit = hit_at(Scene(test::describe({mesh})), 0.5f, 1);
    EXPECT_NEAR(hit.shading.s.y, mirrored ? -1 : 1, 1e-6f);
    EXPECT_NEAR(dot(cross(hit.shading.s, hit.shading.t), hit.shading.n), 1, 1e-6f);
  }
}

TEST(Intersect, DegenerateUvsStillGiveAFrame) {
  TriangleMesh mesh = triangle();
  mesh.uvs = {{1, 1}, {1, 1}, {1, 1}};
  const SurfacePoint hit = hit_at(Scene(test::describe({mesh})), 0.5f, 1);
  EXPECT_NEAR(length(hit.shading.s), 1, 1e-6f);
  EXPECT_NEAR(dot(hit.shading.s, hit.shading.n), 0, 1e-6f);
}

TEST(Intersect, FlippedNormalsPointTheOtherWay) {
  TriangleMesh mesh = triangle();
  mesh.flip_normals = true;
  const SurfacePoint hit = hit_at(Scene(test::describe({mesh})), 0.5f, 1);
  EXPECT_EQ(hit.geometric_normal, (Normal3{0, 0, -1}));
  EXPECT_EQ(hit.shading.n, (Normal3{0, 0, -1}));
}

TEST(Intersect, TheShadingNormalIsInterpolatedOnTheGeometricSide) {
  TriangleMesh mesh = triangle();
  for (const float side : {1.0f, -1.0f}) {
    mesh.normals = {{0, 0, side}, {0.6f, 0, 0.8f * side}, {0, 0, side}};
    const SurfacePoint hit = hit_at(Scene(test::describe({mesh})), 1, 0.5f);  // b1 = 1/2
    const Vec3 expected = normalize(Vec3{0.3f * side, 0, 0.9f});
    EXPECT_NEAR(hit.shading.n.x, expected.x, 1e-5f);
    EXPECT_NEAR(hit.shading.n.z, expected.z, 1e-5f);
    EXPECT_EQ(hit.geometric_normal, (Normal3{0, 0, 1}));
    EXPECT_NEAR(dot(hit.shading.s, hit.shading.n), 0, 1e-6f);
  }
}

TEST(Intersect, NormalsThatCancelFallBackToTheGeometricOne) {
  TriangleMesh mesh = triangle();
  mesh.normals = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(hit_at(Scene(test::describe({mesh})), 0.5f, 1).shading.n, (Normal3{0, 0, 1}));
}

TEST(Intersect, SeesBothSidesAndTheNearestSurface) {
  TriangleMesh far = triangle();
  for (Point3& p : far.positions) p.z = -3;
  const Scene scene(test::describe({far, triangle()}));
  EXPECT_EQ(hit_at(scene, 0.5f, 1).mesh, 1u);
  const auto from_below = scene.intersect({{0.5f, 1, -1}, {0, 0, 1}});
  ASSERT_TRUE(from_below);
  EXPECT_EQ(from_below->mesh, 1u);
  EXPECT_EQ(from_below->geometric_normal, (Normal3{0, 0, 1}));
}

TEST(Intersect, EndsAtTheMaximumDistance) {
  const Scene scene(test::describe({triangle()}));
  const Ray shorter{{0.5f, 1, 1}, {0, 0, -1}, 0.999f}, longer{{0.5f, 1, 1}, {0, 0, -1}, 1.001f};
  EXPECT_FALSE(scene.intersect(shorter));
  EXPECT_FALSE(scene.occluded(shorter));
  EXPECT_TRUE(scene.intersect(longer));
  EXPECT_TRUE(scene.occluded(longer));
  EXPECT_FALSE(scene.occluded({{5, 5, 1}, {0, 0, -1}}));
}

TEST(Intersect, TrianglesWithoutAreaAreNeverHit) {
  TriangleMesh mesh = triangle();
  mesh.triangles = {{0, 1, 1}, {0, 1, 2}, {2, 2, 2}};
  mesh.positions.push_back({1, 2, 0});  // half way from 1 to 2
  mesh.triangles.push_back({1, 3, 2});
  const Scene scene(test::describe({mesh}));
  EXPECT_EQ(scene.triangle_count(), 1u);
  EXPECT_EQ(hit_at(scene, 0.5f, 1).triangle, 0u);
}

TEST(Scene, MayBeEmpty) {
  TriangleMesh nothing;
  nothing.name = "nothing";
  for (SceneDescription& description : std::vector{SceneDescription(), test::describe({nothing})}) {
    const Scene scene(std::move(description));
    EXPECT_FALSE(scene.intersect({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_FALSE(scene.occluded({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_TRUE(scene.bounds().empty());
    EXPECT_EQ(scene.triangle_count(), 0u);
  }
}

TEST(Scene, BoundsHoldUsedVerticesOnly) {
  TriangleMesh mesh = triangle();
  mesh.positions.push_back({100, 100, 100});
  const Scene scene(test::describe({mesh}));
  EXPECT_EQ(scene.bounds().lower, (Point3{0, 0, 0}));
  EXPECT_EQ(scene.bounds().upper, (Point3{2, 4, 0}));
  EXPECT_GT(scene.memory_bytes(), sizeof(Point3) * 4 + 12);
}

TEST(Scene, CanBeMoved) {
  Scene first(test::describe({triangle()}));
  Scene second = std::move(first);
  EXPECT_EQ(hit_at(second, 0.5f, 1).mesh, 0u);
  second = Scene(test::describe({}));
  EXPECT_FALSE(second.intersect({{0.5f, 1, 1}, {0, 0, -1}}));
}

std::string refusal(const SceneDescription& description) {
  try {
    const Scene scene(description);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.message();
  }
  return "accepted";
}

TEST(Scene, RefusesInconsistentMeshesByName) {
  const auto with = [](auto change) {
    TriangleMesh mesh = triangle();
    change(mesh);
    return refusal(test::describe({mesh}));
  };
  constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
  const std::string name = "mesh \"three corners\": ";
  EXPECT_EQ(with([](auto&) {}), "accepted");
  EXPECT_EQ(with([](auto& m) { m.triangles[0][1] = 3; }), name + "triangle 0 asks for vertex 3, there are 3");
  EXPECT_EQ(with([](auto& m) { m.positions[1].y = k_nan; }), name + "position 1 is not finite");
  EXPECT_EQ(with([](auto& m) { m.positions[2].z = k_infinity; }), name + "position 2 is not finite");
  EXPECT_EQ(with([](auto& m) { m.normals.resize(2); }),
            name + "has 2 normals for 3 vertices, needs one per vertex or none");
  EXPECT_EQ(with([](auto& m) { m.uvs.resize(4); }), name + "has 4 uvs for 3 vertices, needs one per vertex or none");
  EXPECT_EQ(with([](auto& m) { m.normals.resize(3), m.normals[0].x = k_nan; }), name + "normal 0 is not finite");
  EXPECT_EQ(with([](auto& m) { m.uvs.resize(3), m.uvs[2].x = k_nan; }), name + "uv 2 is not finite");
  EXPECT_EQ(with([](auto& m) { m.material = 1; }), name + "has material 1, there are 1");
  EXPECT_EQ(with([](auto& m) { m.area_light = 0; }), name + "has area light 0, there are 0");
}

}  // namespace
}  // namespace gradslc
