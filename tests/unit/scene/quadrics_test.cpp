#include "scene/loaders/quadrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "loader_fixtures.h"
#include "scene/scene.h"
#include "scene_fixtures.h"

namespace gradslc {
namespace {

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [i, j, k] : mesh.triangles)
    sum += triangle_area(mesh.positions[i], mesh.positions[j], mesh.positions[k]);
  return sum;
}

/// Edges, by position, that do not have exactly one neighbour in the other direction.
std::size_t open_edges(const TriangleMesh& mesh) {
  using Place = std::tuple<float, float, float>;
  const auto place = [&](std::uint32_t vertex) {
    const Point3 p = mesh.positions[vertex];
    return Place{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // -0 is 0
  };
  std::map<std::pair<Place, Place>, int> balance;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Place a = place(triangle[i]), b = place(triangle[(i + 1) % 3]);
      if (a < b)
        ++balance[{a, b}];
      else
        --balance[{b, a}];
    }
  std::size_t open = 0;
  for (const auto& [edge, sum] : balance) open += sum != 0;
  return open;
}

/// Every point of the mesh's surface that is looked at: corners, edges' middles and triangles' middles.
template <class Look>
void look_at_surface(const TriangleMesh& mesh, const Look& look) {
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = from_origin(mesh.positions[i]), b = from_origin(mesh.positions[j]),
               c = from_origin(mesh.positions[k]);
    for (const Vec3 p : {a, b, c, (a + b) / 2, (b + c) / 2, (c + a) / 2, (a + b + c) / 3}) look(p);
  }
}

TEST(Quadrics, TheSphereHasItsAreaAndSilhouette) {
  const TriangleMesh sphere = unit_sphere();
  EXPECT_NEAR(area(sphere) / (4 * std::numbers::pi), 1, 1e-6);
  look_at_surface(sphere, [](Vec3 p) { ASSERT_NEAR(length(p), 1, 1e-4f); });
  EXPECT_EQ(open_edges(sphere), 0u);
}

TEST(Quadrics, TheSpheresNormalsAreExactAndItsWindingFollowsThem) {
  const TriangleMesh sphere = unit_sphere();
  for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
    const Vec3 direction = normalize(from_origin(sphere.positions[i]));
    ASSERT_NEAR(length(direction - as_vec(sphere.normals[i])), 0, 1e-6f);
  }
  for (const auto& [i, j, k] : sphere.triangles) {
    const Normal3 n = triangle_shape(sphere.positions[i], sphere.positions[j], sphere.positions[k]).normal;
    ASSERT_GT(dot(n, from_origin(sphere.positions[i])), 0.999f);
  }
}

TEST(Quadrics, TheSpheresUvsAreItsAngles) {
  const TriangleMesh sphere = unit_sphere();
  for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
    const Vec3 p = normalize(from_origin(sphere.positions[i]));
    const Vec2 uv = sphere.uvs[i];
    ASSERT_NEAR(std::acos(std::clamp(p.z, -1.0f, 1.0f)) * k_inv_pi, uv.y, 5e-4f);  // acos is ill-conditioned at poles
    if (std::abs(p.z) > 0.9999f) continue;
    ASSERT_NEAR(p.x, std::sin(k_pi * uv.y) * std::cos(2 * k_pi * uv.x), 1e-5f);
    ASSERT_NEAR(p.y, std::sin(k_pi * uv.y) * std::sin(2 * k_pi * uv.x), 1e-5f);
  }
}

TEST(Quadrics, TheDiskIsFlatAndHasItsArea) {
  const TriangleMesh disk = unit_disk();
  EXPECT_NEAR(area(disk) / std::numbers::pi, 1, 1e-6);
  EXPECT_TRUE(disk.normals.empty());
  for (std::size_t i = 0; i < disk.positions.size(); ++i) {
    const Point3 p = disk.positions[i];
    const float r = std::hypot(p.x, p.y);
    ASSERT_EQ(p.z, 0);
    ASSERT_NEAR(r, disk.uvs[i].x, 1e-4f);
    if (r > 0) {
      ASSERT_NEAR(p.x, r * std::cos(2 * k_pi * disk.uvs[i].y), 1e-5f);
      ASSERT_NEAR(p.y, r * std::sin(2 * k_pi * disk.uvs[i].y), 1e-5f);
    }
  }
  for (const auto& [i, j, k] : disk.triangles)
    ASSERT_EQ(triangle_shape(disk.positions[i], disk.positions[j], disk.positions[k]).normal, (Normal3{0, 0, 1}));
}

TEST(Quadrics, TheCylinderHasItsAreaAndSilhouetteAndNoCaps) {
  const TriangleMesh cylinder = unit_cylinder();
  EXPECT_NEAR(area(cylinder) / (2 * std::numbers::pi), 1, 1e-6);
  look_at_surface(cylinder, [](Vec3 p) { ASSERT_NEAR(std::hypot(p.x, p.y), 1, 1e-4f); });
  EXPECT_EQ(open_edges(cylinder), 2 * 256u);  // the two rims
  for (std::size_t i = 0; i < cylinder.positions.size(); ++i) {
    const Point3 p = cylinder.positions[i];
    ASSERT_EQ(p.z, cylinder.uvs[i].y);
    ASSERT_NEAR(p.x, std::cos(2 * k_pi * cylinder.uvs[i].x), 1e-4f);
    ASSERT_NEAR(p.y, std::sin(2 * k_pi * cylinder.uvs[i].x), 1e-4f);
    ASSERT_NEAR(length(as_vec(cylinder.normals[i])), 1, 1e-6f);
  }
  for (const auto& [i, j, k] : cylinder.triangles) {
    const Normal3 n = triangle_shape(cylinder.positions[i], cylinder.positions[j], cylinder.positions[k]).normal;
    ASSERT_GT(dot(n, cylinder.normals[i]), 0.999f);
  }
}

SurfacePoint hit(const Scene& scene, Point3 origin, Vec3 direction) {
  const auto found = scene.intersect({origin, normalize(direction)});
  EXPECT_TRUE(found);
  return found.value_or(SurfacePoint());
}

TEST(Quadrics, ASphereStandsWhereItsPropertiesSay) {
  const Scene scene(test::load(R"(<shape type="sphere"><point name="center" x="1" y="2" z="3"/>
      <float name="radius" value="0.5"/>
      <transform name="to_world"><scale x="2" y="1" z="1"/></transform></shape>)"));
  const SurfacePoint right = hit(scene, {9, 2, 3}, {-1, 0, 0});
  EXPECT_NEAR(right.position.x, 3, 1e-3f);
  EXPECT_NEAR(right.geometric_normal.x, 1, 1e-3f);
  // At 45 degrees of its parameter the ellipse's normal is (1/2, 1) / |.|.
  const float c = std::sqrt(0.5f) / 2;
  const SurfacePoint slope = hit(scene, {2 + 2 * c, 9, 3}, {0, -1, 0});
  EXPECT_NEAR(slope.position.y, 2 + c, 1e-3f);
  EXPECT_NEAR(slope.shading_normal.x, 0.5f / std::sqrt(1.25f), 2e-3f);
  EXPECT_NEAR(slope.shading_normal.y, 1 / std::sqrt(1.25f), 2e-3f);
}

TEST(Quadrics, MirroringKeepsNormalsOutsideAndFlippingTurnsThem) {
  const auto normal = [](std::string_view body) {
    const Scene scene(test::load(body));
    const SurfacePoint point = hit(scene, {0, 0.3f, 9}, {0, 0, -1});
    EXPECT_GT(dot(point.geometric_normal, point.shading_normal), 0);
    return point.geometric_normal.z;
  };
  for (const char* shape : {"sphere", "disk"}) {
    const auto with = [&](const char* properties) {
      return normal(fmt::format(R"(<shape type="{}">{}</shape>)", shape, properties));
    };
    constexpr const char* k_mirror = R"(<transform name="to_world"><scale x="-1"/></transform>)";
    EXPECT_GT(with(""), 0.5f);
    EXPECT_GT(with(k_mirror), 0.5f);
    EXPECT_LT(with(R"(<boolean name="flip_normals" value="true"/>)"), -0.5f);
    EXPECT_LT(
        with(R"(<boolean name="flip_normals" value="true"/><transform name="to_world"><scale x="-1"/></transform>)"),
        -0.5f);
  }
}

TEST(Quadrics, ACylinderGoesFromP0ToP1) {
  const Scene scene(
      test::load(R"(<shape type="cylinder"><point name="p0" value="1 0 0"/><point name="p1" x="1" y="4" z="0"/>
      <float name="radius" value="0.25"/></shape>)"));
  EXPECT_NEAR(scene.bounds().lower.y, 0, 1e-5f);
  EXPECT_NEAR(scene.bounds().upper.y, 4, 1e-5f);
  const SurfacePoint side = hit(scene, {9, 1, 0}, {-1, 0, 0});
  EXPECT_NEAR(side.position.x, 1.25f, 1e-4f);
  EXPECT_NEAR(side.geometric_normal.x, 1, 1e-3f);
  EXPECT_NEAR(side.uv.y, 0.25f, 1e-4f);
  EXPECT_FALSE(scene.intersect({{1, 9, 0}, {0, -1, 0}}));  // no caps
}

TEST(Quadrics, RefuseWhatHasNoSurface) {
  EXPECT_EQ(test::refusal(R"(<shape type="sphere"><float name="radius" value="0"/></shape>)"),
            "test.xml:2:43: error: /scene/shape/float: radius must be above 0, not 0");
  EXPECT_EQ(test::refusal(R"(<shape type="cylinder"><point name="p1" x="0" y="0" z="0"/></shape>)"),
            "test.xml:2:25: error: /scene/shape/point: p0 and p1 must differ");
  EXPECT_EQ(test::refusal(R"(<shape type="sphere"><point name="center" x="0" y="0"/></shape>)"),
            "test.xml:2:23: error: /scene/shape/point: attribute \"z\" is missing");
  EXPECT_EQ(test::refusal(R"(<shape type="spher"/>)"),
            "test.xml:2:8: error: /scene/shape: unknown shape \"spher\"; did you mean \"sphere\"?");
}

}  // namespace
}  // namespace gradslc
