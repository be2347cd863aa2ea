#include "shifts/reconnection.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/random.h"

namespace gradslc {
namespace {

struct Case {
  Point3 base, offset, target;
  Normal3 normal;
};
std::array<Case, 200> random_cases() {
  TestRandom random(7);
  const auto in_ball = [&] { return random.get1() * random.direction(); };
  std::array<Case, 200> cases;
  for (Case& c : cases) {
    const Vec3 normal = normalize(in_ball());
    const Point3 target = Point3{} + in_ball();
    const auto above = [&] {
      const Vec3 v = in_ball();
      return target + std::copysign(1.0f, dot(v, normal)) * v + 0.05f * normal;
    };
    c = {above(), above(), target, as_normal(random.get1() < 0.5f ? normal : -normal)};
  }
  return cases;
}

TEST(Reconnection, IsItsOwnInverse) {
  for (const auto& [base, offset, target, normal] : random_cases()) {
    const auto there = reconnect(base, offset, target, normal), back = reconnect(offset, base, target, normal);
    ASSERT_TRUE(there && back);
    EXPECT_NEAR(there->jacobian * back->jacobian, 1, 1e-4);
    EXPECT_NEAR(length(there->direction - normalize(target - offset)), 0, 1e-6);
  }
}

TEST(Reconnection, OfAPointToItselfIsTheIdentity) {
  for (const auto& [base, offset, target, normal] : random_cases())
    EXPECT_NEAR(reconnect(base, base, target, normal)->jacobian, 1, 1e-5);
  EXPECT_EQ(reconnect_to_infinity({0, 0, 1}).jacobian, 1);
}

/// Solid angle of a small parallelogram's two triangles, to first order that of the surface around `centre`.
double solid_angle(Point3 from, Point3 centre, Vec3 s, Vec3 t) {
  const auto cross_product = [](const double(&a)[3], const double(&b)[3]) {
    return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  // Central differences of the unit direction over the surface.
  double derivative[2][3];
  for (int k = 0; k < 2; ++k) {
    const Vec3 step = k == 0 ? s : t;
    double ends[2][3];
    for (int e = 0; e < 2; ++e) {
      const double sign = e == 0 ? -1 : 1;
      double v[3] = {centre.x + sign * step.x - from.x, centre.y + sign * step.y - from.y,
                     centre.z + sign * step.z - from.z};
      const double norm = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      for (int i = 0; i < 3; ++i) ends[e][i] = v[i] / norm;
    }
    for (int i = 0; i < 3; ++i) derivative[k][i] = ends[1][i] - ends[0][i];
  }
  const auto area = cross_product(derivative[0], derivative[1]);
  return std::sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
}

// The same piece of the target's surface, seen from both.
TEST(Reconnection, JacobianIsTheRatioOfSolidAngles) {
  for (const auto& [base, offset, target, normal] : random_cases()) {
    const Vec3 n = as_vec(normal);
    const Vec3 s = 1e-3f * normalize(std::abs(n.x) < 0.5f ? cross(n, {1, 0, 0}) : cross(n, {0, 1, 0}));
    const Vec3 t = cross(n, s);
    const double expected = solid_angle(offset, target, s, t) / solid_angle(base, target, s, t);
    EXPECT_NEAR(reconnect(base, offset, target, normal)->jacobian / expected, 1, 2e-2);
  }
}

TEST(Reconnection, SaysWhyItFails) {
  const Point3 base{0, 0, 1}, target{0, 0, 0};
  const Normal3 up{0, 0, 1};
  EXPECT_EQ(reconnect(base, {1, 0, -1}, target, up).failure(), ShiftFailure::back_facing);
  EXPECT_EQ(reconnect(base, {1, 0, 0}, target, up).failure(), ShiftFailure::degenerate);
  EXPECT_EQ(reconnect({1, 0, 0}, base, target, up).failure(), ShiftFailure::degenerate);
  EXPECT_EQ(reconnect(base, target, target, up).failure(), ShiftFailure::degenerate);
}

}  // namespace
}  // namespace gradslc
