// Rays that leave and segments that join surfaces: no self-intersection, no leaks, at any scale and place.

#include <gtest/gtest.h>

#include "core/warp.h"
#include "scene_fixtures.h"

namespace gradslc {
namespace {

using test::Random;

struct Placement {
  const char* name;
  double scale, offset, degrees;
};
constexpr Placement k_placements[] = {
    {"millimetres", 1e-3, 0, 0},
    {"unit", 1, 0, 0},
    {"kilometres", 1e3, 0, 0},
    {"unit_turned", 1, 0, 37},
    {"kilometres_turned", 1e3, 0, 37},
    {"millimetres_turned", 1e-3, 0, 37},
    {"unit_far", 1, 1e4, 0},
    {"kilometres_far", 1e3, 1e4, 0},
    {"kilometres_far_turned", 1e3, 1e4, 37},
};

Transform placement(const Placement& p) {
  return Transform::translation(p.offset, 0.7 * p.offset, -p.offset) * Transform::scaling(p.scale, p.scale, p.scale) *
         Transform::rotation(1, 2, 3, p.degrees);
}

class Robustness : public testing::TestWithParam<Placement> {
 protected:
  static constexpr int k_samples = 50000;

  /// A point on a front side that a ray from a random point of the room meets.
  SurfacePoint surface_point(const Scene& scene) {
    for (;;) {
      const auto coordinate = [&] { return static_cast<float>(1.9 * random_.uniform() - 0.95); };
      const float x = coordinate(), y = coordinate(), z = coordinate();
      const Vec3 direction = square_to_sphere(random_.get2());
      const auto hit = scene.intersect({map_.apply(Point3{x, y, z}), direction});
      EXPECT_TRUE(hit) << "a ray from inside leaves the closed room";
      if (!hit) return {};
      if (dot(hit->geometric_normal, direction) < 0) return *hit;
    }
  }
  /// A direction above the surface, with a cosine from 1e-6 to 1, evenly by its logarithm.
  Vec3 direction_above(const SurfacePoint& point) {
    const double cosine = std::pow(10.0, -6 * random_.uniform());
    const double sine = std::sqrt(1 - cosine * cosine), phi = 2 * std::numbers::pi * random_.uniform();
    return frame_from_normal(point.geometric_normal)
        .to_world({static_cast<float>(sine * std::cos(phi)), static_cast<float>(sine * std::sin(phi)),
                   static_cast<float>(cosine)});
  }

  Transform map_ = placement(GetParam());
  Random random_{17};
};

TEST_P(Robustness, RaysFromWallsAndBlocksNeitherHitTheirOwnPlaneNorLeaveTheRoom) {
  std::vector<TriangleMesh> meshes = test::room();
  meshes.push_back(
      test::block({-0.35f, -0.4f, -0.3f}, {0.3f, 0.6f, 0.3f}, -18));  // stands on the floor, as in the Cornell box
  meshes.push_back(test::block({0.35f, -0.7f, 0.4f}, {0.3f, 0.3f, 0.3f}, 17));
  test::transform(meshes, map_);
  const Scene scene(test::describe(meshes));
  int self_hits = 0, leaks = 0;
  for (int i = 0; i < k_samples; ++i) {
    const SurfacePoint point = surface_point(scene);
    const auto hit = scene.intersect(spawn_ray(point, direction_above(point)));
    if (!hit) ++leaks;
    if (hit && hit->mesh == point.mesh) ++self_hits;  // all meshes are convex
  }
  EXPECT_EQ(self_hits, 0);
  EXPECT_EQ(leaks, 0);
}

TEST_P(Robustness, AnyTwoWallsOfAConvexRoomSeeEachOther) {
  std::vector<TriangleMesh> meshes = test::room();
  test::transform(meshes, map_);
  const Scene scene(test::describe(meshes));
  int occluded = 0, pairs = 0;
  for (int i = 0; i < k_samples; ++i) {
    const SurfacePoint a = surface_point(scene), b = surface_point(scene);
    const Vec3 d = b.position - a.position;
    if (a.mesh == b.mesh || dot(a.geometric_normal, d) <= 0 || dot(b.geometric_normal, d) >= 0) continue;
    ++pairs;
    if (scene.occluded(segment(offset_position(a, d), offset_position(b, -d)))) ++occluded;
  }
  EXPECT_GT(pairs, k_samples / 2);
  EXPECT_EQ(occluded, 0);
}

TEST_P(Robustness, SegmentsThroughAWallAreOccludedHoweverCloseToItTheyStart) {
  std::vector<TriangleMesh> meshes = test::room();
  test::transform(meshes, map_);
  const Scene scene(test::describe(meshes));
  const double reach = GetParam().scale * 0.5;
  int open = 0;
  for (int i = 0; i < k_samples; ++i) {
    const SurfacePoint point = surface_point(scene);
    const Vec3 inwards = direction_above(point);
    if (dot(inwards, point.geometric_normal) < 1e-2f) continue;
    const Point3 inside = offset_position(point, inwards);
    const Point3 outside = offset_position(point, -inwards) + static_cast<float>(-reach) * inwards;
    if (!scene.occluded(segment(inside, outside))) ++open;
  }
  EXPECT_EQ(open, 0);
}

INSTANTIATE_TEST_SUITE_P(Placements, Robustness, testing::ValuesIn(k_placements),
                         [](const auto& placed) { return std::string(placed.param.name); });

// A small triangle far from where it is looked at: the distance's rounding is larger than the offset.
TEST(Segments, EndOpenlyOnSmallDistantTrianglesSeenAtGrazingAngles) {
  Random random(5);
  for (const double distance : {1.0, 30.0, 1000.0}) {
    for (int scene_index = 0; scene_index < 20; ++scene_index) {
      std::vector<TriangleMesh> meshes = {test::parallelogram({-1e-3f, -1e-3f, 0}, {2e-3f, 0, 0}, {0, 2e-3f, 0})};
      const Vec3 axis = square_to_sphere(random.get2());
      test::transform(meshes, Transform::translation(1, 2, 3) *
                                  Transform::rotation(axis.x, axis.y, axis.z, 360 * random.uniform()));
      const Scene scene(test::describe(meshes));
      const Normal3 normal = as_normal(normalize(
          cross(meshes[0].positions[1] - meshes[0].positions[0], meshes[0].positions[3] - meshes[0].positions[0])));
      for (int i = 0; i < 500; ++i) {
        const double cosine = std::pow(0.0175, random.uniform());  // up to 89 degrees
        const double sine = std::sqrt(1 - cosine * cosine), phi = 2 * std::numbers::pi * random.uniform();
        const Vec3 away =
            frame_from_normal(normal).to_world({static_cast<float>(sine * std::cos(phi)),
                                                static_cast<float>(sine * std::sin(phi)), static_cast<float>(cosine)});
        const Point3 centre = meshes[0].positions[0] + 0.3f * (meshes[0].positions[2] - meshes[0].positions[0]);
        const auto hit = scene.intersect({centre + 0.01f * as_vec(normal), -as_vec(normal)});
        ASSERT_TRUE(hit);
        const Point3 from = hit->position + static_cast<float>(distance) * away;
        EXPECT_FALSE(scene.occluded(segment(from, offset_position(*hit, away)))) << distance << " " << cosine;
      }
    }
  }
}

TEST(OffsetPosition, MovesToTheSideOfTheDirectionByTheError) {
  SurfacePoint point;
  point.position = {1, 2, 3};
  point.geometric_normal = {0, 0, 1};
  point.error = 0.25f;
  EXPECT_EQ(offset_position(point, {1, 0, 0.1f}), (Point3{1, 2, 3.25f}));
  EXPECT_EQ(offset_position(point, {1, 0, -0.1f}), (Point3{1, 2, 2.75f}));
  EXPECT_EQ(offset_position(Point3{1, 2, 3}, {0, 0, 1}, 0.25f, {0, 0, -1}), (Point3{1, 2, 2.75f}));
}

// The bound scales with the scene: nothing in it is an absolute length.
TEST(PositionError, ScalesWithTheScene) {
  for (const float scale : {0x1p-20f, 0x1p20f}) {
    const Scene unit(test::describe({test::parallelogram({0, 0, 1}, {1, 0, 0}, {0, 1, 0})}));
    const Scene scaled(test::describe({test::parallelogram({0, 0, scale}, {scale, 0, 0}, {0, scale, 0})}));
    const auto a = unit.intersect({{0.25f, 0.375f, 0}, {0, 0, 1}});
    const auto b = scaled.intersect({{0.25f * scale, 0.375f * scale, 0}, {0, 0, 1}});
    ASSERT_TRUE(a && b);
    EXPECT_GT(a->error, 0);
    EXPECT_EQ(a->error * scale, b->error);
  }
}

}  // namespace
}  // namespace gradslc
