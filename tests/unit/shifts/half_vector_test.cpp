#include "shifts/half_vector.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "core/frame.h"
#include "support/random.h"

namespace gradslc {
namespace {

struct Case {
  Vec3 wo_base, wi_base;
  float eta_base;
  Vec3 wo_offset;
  float eta_offset;
};
using Copy = std::function<ShiftResult<ShiftedDirection>(const Vec3& wi_base, const Case&)>;

ShiftResult<ShiftedDirection> reflected(const Vec3& wi, const Case& c) {
  return copy_half_vector_of_reflection(c.wo_base, wi, c.wo_offset);
}
ShiftResult<ShiftedDirection> refracted(const Vec3& wi, const Case& c) {
  return copy_half_vector_of_refraction(c.wo_base, wi, c.eta_base, c.wo_offset, c.eta_offset);
}

/// Cases whose copy exists, on both sides of the surface; offsets lie within some 20 degrees of their bases.
std::vector<Case> random_cases(const Copy& copy, bool transmitted) {
  TestRandom random(3);
  std::vector<Case> cases;
  while (cases.size() < 300) {
    Case c;
    c.wo_base = random.direction(), c.wi_base = random.direction();
    c.eta_base = 1.2f + random.get1(), c.eta_offset = 1.2f + random.get1();
    if ((c.wo_base.z * c.wi_base.z < 0) != transmitted) continue;
    c.wo_offset = normalize(c.wo_base + 0.35f * random.direction());
    const auto shifted = copy(c.wi_base, c);
    // Away from grazing angles, where finite differences are not exact.
    if (shifted && std::abs(shifted->direction.z) > 0.15f && std::abs(c.wi_base.z) > 0.15f &&
        shifted->jacobian > 0.02f && shifted->jacobian < 50)
      cases.push_back(c);
  }
  return cases;
}

/// |dw'/dw| by central differences; -1 where there are none.
float finite_difference(const Copy& copy, const Case& c, float step_size) {
  const Frame frame = frame_from_normal(as_normal(c.wi_base));
  Vec3 derivative[2];
  for (int k = 0; k < 2; ++k) {
    const Vec3 step = step_size * (k == 0 ? frame.s : frame.t);
    const auto plus = copy(normalize(c.wi_base + step), c), minus = copy(normalize(c.wi_base - step), c);
    if (!plus || !minus) return -1;
    derivative[k] = (plus->direction - minus->direction) / (2 * step_size);
  }
  return length(cross(derivative[0], derivative[1]));
}

void expect_jacobian(const Copy& copy, bool transmitted) {
  int compared = 0;
  for (const Case& c : random_cases(copy, transmitted)) {
    const float expected = finite_difference(copy, c, 2e-3f), coarser = finite_difference(copy, c, 6e-3f);
    if (expected < 0 || std::abs(coarser / expected - 1) > 0.01f) continue;  // near a critical angle
    ++compared;
    EXPECT_NEAR(copy(c.wi_base, c)->jacobian / expected, 1, 0.02);
  }
  EXPECT_GT(compared, 250);
}
TEST(HalfVectorCopy, JacobianOfReflectionAgainstFiniteDifferences) { expect_jacobian(reflected, false); }
TEST(HalfVectorCopy, JacobianOfRefractionAgainstFiniteDifferences) { expect_jacobian(refracted, true); }

void expect_inverse(const Copy& copy, bool transmitted) {
  for (const Case& c : random_cases(copy, transmitted)) {
    const auto there = copy(c.wi_base, c);
    const auto back = copy(there->direction, {c.wo_offset, {}, c.eta_offset, c.wo_base, c.eta_base});
    ASSERT_TRUE(back);
    EXPECT_NEAR(length(back->direction - c.wi_base), 0, 2e-4);
    EXPECT_NEAR(there->jacobian * back->jacobian, 1, 5e-3);
  }
}
TEST(HalfVectorCopy, OfReflectionIsItsOwnInverse) { expect_inverse(reflected, false); }
TEST(HalfVectorCopy, OfRefractionIsItsOwnInverse) { expect_inverse(refracted, true); }

TEST(HalfVectorCopy, ToTheSameVertexIsTheIdentity) {
  for (const bool transmitted : {false, true})
    for (Case c : random_cases(transmitted ? refracted : reflected, transmitted)) {
      c.wo_offset = c.wo_base, c.eta_offset = c.eta_base;
      const auto shifted = transmitted ? refracted(c.wi_base, c) : reflected(c.wi_base, c);
      if (!shifted) continue;  // no facet refracts so
      EXPECT_NEAR(length(shifted->direction - c.wi_base), 0, 2e-4);
      EXPECT_NEAR(shifted->jacobian, 1, 2e-3);
    }
}

TEST(HalfVectorCopy, SaysWhyItFails) {
  const Vec3 up{0, 0, 1}, oblique = normalize({1, 0, 1}), grazing = normalize({1, 0, 0.05f});
  using enum ShiftFailure;
  EXPECT_EQ(copy_half_vector_of_reflection(up, up, -up).failure(), back_facing);
  EXPECT_EQ(copy_half_vector_of_reflection(up, -up, up).failure(), degenerate);
  // The facet leans away from the offset's direction, whose mirror image lies below the surface.
  EXPECT_EQ(copy_half_vector_of_reflection(up, oblique, normalize({-1, 0, 0.2f})).failure(), back_facing);

  EXPECT_EQ(copy_half_vector_of_refraction(up, -up, 1.5f, -up, 1.5f).failure(), back_facing);
  EXPECT_EQ(copy_half_vector_of_refraction(up, -up, 1, up, 1.5f).failure(), degenerate);
  EXPECT_EQ(copy_half_vector_of_refraction(oblique, normalize({1, 0, -0.2f}), 1.5f, oblique, 1.5f).failure(),
            degenerate);  // bent to the wrong side
  EXPECT_EQ(copy_half_vector_of_refraction(-up, up, 1.5f, -grazing, 1.5f).failure(), total_internal_reflection);
}

}  // namespace
}  // namespace gradslc
