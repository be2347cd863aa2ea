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
}

// A material that asks for derivatives gets those of its point.
class DerivativeMaterial final : public Material {
 public:
  void shade(const MaterialPoint& point, const Vec3&, Shading& shading) const override {
    shading.bsdf.add(Lambert{Rgb(point.dp_du.x, point.dp_du.y, point.dp_dv.x)});
  }
  bool has_other_lobes(const LobeSelection&) const override { return false; }
  float max_connectable_pi_f(const LobeSelection&) const override { return 1; }
  bool needs_derivatives() const override { return true; }
};

ShadedPoint shaded(const TriangleMesh& mesh) {
  SceneDescription description = test::describe({mesh});
  description.materials = {std::make_shared<DerivativeMaterial>()};
  const Scene scene(std::move(description));
  return scene.shade(hit_at(scene, 0.5f, 1), {0, 0, 1});
}

TEST(Shade, TheTangentPointsToWhereUGrows) {
  TriangleMesh mesh = triangle();
  for (const bool mirrored : {false, true}) {
    mesh.uvs = {{0, 0}, {0, 1}, {mirrored ? -4.0f : 4.0f, 0}};  // u grows along +y or -y, v along +x
    const ShadedPoint point = shaded(mesh);
    EXPECT_NEAR(point.frame.s.y, mirrored ? -1 : 1, 1e-6f);
    EXPECT_NEAR(dot(cross(point.frame.s, point.frame.t), point.frame.n), 1, 1e-6f);
    const Rgb derivatives = point.bsdf.albedo();
    EXPECT_NEAR(derivatives.r, 0, 1e-6f);
    EXPECT_NEAR(derivatives.g, mirrored ? -1 : 1, 1e-6f);  // 4 along y
    EXPECT_NEAR(derivatives.b, 2, 1e-6f);                  // 2 along x
  }
}

TEST(Shade, WithoutUvsTheTangentIsTheFirstEdge) { EXPECT_EQ(shaded(triangle()).frame.s, (Vec3{1, 0, 0})); }

TEST(Shade, DegenerateUvsStillGiveAFrame) {
  TriangleMesh mesh = triangle();
  mesh.uvs = {{1, 1}, {1, 1}, {1, 1}};
  const ShadedPoint point = shaded(mesh);
  EXPECT_NEAR(length(point.frame.s), 1, 1e-6f);
  EXPECT_NEAR(dot(point.frame.s, point.frame.n), 0, 1e-6f);
  EXPECT_EQ(point.bsdf.albedo(), Rgb());
}

// Behind a two-sided surface everything is as before it, mirrored.
TEST(Shade, TwoSidedMaterialsFaceThePath) {
  const Scene scene(test::describe({triangle()}));
  const SurfacePoint hit = hit_at(scene, 0.5f, 1);
  const Vec3 wo = normalize(Vec3{0.3f, 0.2f, 0.7f});
  for (const float side : {1.0f, -1.0f}) {
    const ShadedPoint point = scene.shade(hit, {wo.x, wo.y, side * wo.z});
    EXPECT_EQ(point.frame.n, (Normal3{0, 0, side}));
    EXPECT_NEAR(point.wo.z, wo.z, 1e-6f);
    const Vec3 back = point.to_world(point.to_local(wo));
    EXPECT_NEAR(length(back - wo), 0, 1e-6f);
  }
}

TEST(Intersect, FlippedNormalsPointTheOtherWay) {
  TriangleMesh mesh = triangle();
  mesh.flip_normals = true;
  const SurfacePoint hit = hit_at(Scene(test::describe({mesh})), 0.5f, 1);
  EXPECT_EQ(hit.geometric_normal, (Normal3{0, 0, -1}));
  EXPECT_EQ(hit.shading_normal, (Normal3{0, 0, -1}));
}

TEST(Intersect, TheGeometricNormalIsOnTheSideOfTheInterpolatedOne) {
  TriangleMesh mesh = triangle();
  for (const float side : {1.0f, -1.0f}) {
    mesh.normals = {{0, 0, side}, {0.6f, 0, 0.8f * side}, {0, 0, side}};
    const SurfacePoint hit = hit_at(Scene(test::describe({mesh})), 1, 0.5f);  // b1 = 1/2
    const Vec3 expected = normalize(Vec3{0.3f, 0, 0.9f * side});
    EXPECT_NEAR(hit.shading_normal.x, expected.x, 1e-5f);
    EXPECT_NEAR(hit.shading_normal.z, expected.z, 1e-5f);
    EXPECT_EQ(hit.geometric_normal, (Normal3{0, 0, side}));
  }
}

TEST(Intersect, NormalsThatCancelFallBackToTheGeometricOne) {
  TriangleMesh mesh = triangle();
  mesh.normals = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(hit_at(Scene(test::describe({mesh})), 0.5f, 1).shading_normal, (Normal3{0, 0, 1}));
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
