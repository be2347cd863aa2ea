#include "core/vec.h"

#include <gtest/gtest.h>

#include <type_traits>

#include "core/bounds.h"
#include "core/frame.h"
#include "support/random.h"

namespace gradslc {
namespace {

static_assert(!std::is_convertible_v<Point3, Vec3> && !std::is_convertible_v<Normal3, Vec3>);

TEST(Vec3, CrossIsRightHandedAndPerpendicular) {
  EXPECT_EQ(cross(Vec3{1, 0, 0}, Vec3{0, 1, 0}), (Vec3{0, 0, 1}));
  const Vec3 a{1, -2, 3}, b{4, 5, -6};
  EXPECT_EQ(dot(cross(a, b), a), 0);
  EXPECT_EQ(dot(cross(a, b), b), 0);
  EXPECT_EQ(cross(a, b), -cross(b, a));
}

TEST(Vec3, LengthsAndComponents) {
  EXPECT_EQ(length(Vec3{2, 3, 6}), 7);
  EXPECT_EQ(length_squared(Vec3{2, 3, 6}), 49);
  EXPECT_EQ(max_component(abs(Vec3{2, -8, 6})), 8);
  EXPECT_EQ(normalize(Vec3{0, 0, -4}), (Vec3{0, 0, -1}));
  EXPECT_EQ(distance(Point3{1, 1, 1}, Point3{1, 4, 5}), 5);
}

TEST(Normal3, FacesForward) {
  const Normal3 n{0, 0, 1};
  EXPECT_EQ(face_forward(n, {0, 1, -0.5f}), (Normal3{0, 0, -1}));
  EXPECT_EQ(face_forward(n, {0, 1, 0.5f}), n);
}

void expect_orthonormal(const Frame& frame) {
  constexpr float error = 2e-6f;
  const Vec3 n = as_vec(frame.n);
  ASSERT_NEAR(dot(frame.s, frame.t), 0, error) << n.x << " " << n.y << " " << n.z;
  ASSERT_NEAR(dot(frame.s, n), 0, error) << n.x << " " << n.y << " " << n.z;
  ASSERT_NEAR(dot(frame.t, n), 0, error) << n.x << " " << n.y << " " << n.z;
  ASSERT_NEAR(length_squared(frame.s), 1, error) << n.x << " " << n.y << " " << n.z;
  ASSERT_NEAR(length_squared(frame.t), 1, error) << n.x << " " << n.y << " " << n.z;
  ASSERT_NEAR(length(cross(frame.s, frame.t) - n), 0, error) << n.x << " " << n.y << " " << n.z;
}

TEST(Frame, IsOrthonormalForMillionsOfNormals) {
  TestRandom random(1);
  for (int i = 0; i < 2'000'000; ++i)
    ASSERT_NO_FATAL_FAILURE(expect_orthonormal(frame_from_normal(as_normal(random.direction()))));
}

TEST(Frame, IsOrthonormalNearThePoles) {
  TestRandom random(2);
  for (const float pole : {-1.0f, 1.0f}) {
    expect_orthonormal(frame_from_normal({0, 0, pole}));
    expect_orthonormal(frame_from_normal({-0.0f, -0.0f, pole}));
    for (int i = 0; i < 200'000; ++i) {
      const float tilt = std::pow(10.0f, -12 * random.get1());
      const Vec3 n = normalize(Vec3{tilt * (random.get1() - 0.5f), tilt * (random.get1() - 0.5f), pole});
      ASSERT_NO_FATAL_FAILURE(expect_orthonormal(frame_from_normal(as_normal(n))));
    }
  }
  expect_orthonormal(frame_from_normal({1, 0, 0.0f}));
  expect_orthonormal(frame_from_normal({0, 1, -0.0f}));
}

TEST(Frame, GoesToWorldAndBack) {
  TestRandom random(3);
  for (int i = 0; i < 1000; ++i) {
    const Frame frame = frame_from_normal(as_normal(random.direction()));
    const Vec3 v = random.direction();
    EXPECT_NEAR(length(frame.to_world(frame.to_local(v)) - v), 0, 1e-6f);
    EXPECT_NEAR(frame.to_local(v).z, dot(v, frame.n), 1e-6f);
  }
}

TEST(Frame, FollowsTheTangentWhereThereIsOne) {
  TestRandom random(4);
  for (int i = 0; i < 10'000; ++i) {
    const Normal3 n = as_normal(random.direction());
    const Vec3 tangent = 100 * random.get1() * random.direction();
    const Frame frame = frame_from_normal_and_tangent(n, tangent);
    if (length(cross(as_vec(n), tangent)) > 1e-2f * length(tangent)) {
      ASSERT_NEAR(length(cross(frame.s, frame.t) - as_vec(n)), 0, 2e-4f);
      ASSERT_NEAR(dot(frame.t, tangent) / length(tangent), 0, 2e-5f);
      ASSERT_GT(dot(frame.s, tangent), 0);
    }
  }
  expect_orthonormal(frame_from_normal_and_tangent({0, 0, 1}, {0, 0, 5}));
  expect_orthonormal(frame_from_normal_and_tangent({0, 0, 1}, {0, 0, 0}));
}

TEST(Bounds3, GrowAndMeasureDistances) {
  Bounds3 box;
  EXPECT_TRUE(box.empty());
  box.extend(Point3{1, 2, 3});
  EXPECT_FALSE(box.empty());
  box.extend(Point3{-1, 4, 3});
  EXPECT_EQ(box.lower, (Point3{-1, 2, 3}));
  EXPECT_EQ(box.upper, (Point3{1, 4, 3}));
  EXPECT_EQ(box.centre(), (Point3{0, 3, 3}));
  EXPECT_EQ(box.max_abs_coordinate(), 4);
  EXPECT_TRUE(box.contains({0, 3, 3}));
  EXPECT_FALSE(box.contains({0, 3, 3.5f}));
  EXPECT_EQ(box.min_distance_squared({0, 3, 3}), 0);
  EXPECT_EQ(box.min_distance_squared({4, 3, -1}), 9 + 16);
  Bounds3 other;
  box.extend(other);
  EXPECT_EQ(box.upper, (Point3{1, 4, 3}));
}

TEST(Bounds3, DistancesEncloseThoseToPointsInside) {
  TestRandom random(5);
  const auto point = [&] { return Point3{} + 3 * random.get1() * random.direction(); };
  for (int i = 0; i < 2000; ++i) {
    Bounds3 box;
    box.extend(point());
    box.extend(point());
    const Point3 p = point();
    for (int k = 0; k < 10; ++k) {
      const Vec3 d = box.diagonal();
      const float x = random.get1(), y = random.get1(), z = random.get1();
      const float squared = distance_squared(p, box.lower + Vec3{x * d.x, y * d.y, z * d.z});
      ASSERT_GE(squared * 1.00001f, box.min_distance_squared(p));
      ASSERT_LE(squared * 0.99999f, box.max_distance_squared(p));
    }
  }
}

}  // namespace
}  // namespace gradslc
