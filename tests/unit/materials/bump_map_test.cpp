#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "materials/plugins.h"

namespace gradslc {
namespace {

/// A height that grows evenly: a u + b v.
class Ramp final : public TextureMap {
 public:
  explicit Ramp(Vec2 slope) : slope_(slope) {}
  Rgb eval(Vec2 uv) const override { return Rgb(slope_.x * uv.x + slope_.y * uv.y); }
  Vec2 gradient(Vec2) const override { return slope_; }
  Rgb max_value() const override { return Rgb(1e30f); }
  Rgb min_value() const override { return Rgb(-1e30f); }
  std::size_t memory_bytes() const override { return 0; }

 private:
  Vec2 slope_;
};

const MaterialPtr k_diffuse = make_diffuse(Texture(Rgb(0.25f, 0.5f, 0.75f)));

MaterialPtr bump(Vec2 slope, float scale = 1) {
  return make_bump_map(k_diffuse, Texture(std::make_shared<Ramp>(slope)), scale);
}
/// A normal in the tangent frame as a normal map holds it.
MaterialPtr constant_normals(Vec3 n, MaterialPtr nested = k_diffuse) {
  return make_normal_map(std::move(nested), Texture(Rgb((n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2)));
}

const MaterialPoint k_plane{{0.3f, 0.6f}, {2, 0, 0}, {0, 3, 0}};  // z = 0, stretched by 2 and 3
constexpr Vec3 k_above{0, 0.6f, 0.8f}, k_below{0, 0.6f, -0.8f};

Shading shade(const Material& material, const MaterialPoint& point = k_plane, Vec3 known = k_above, Frame frame = {}) {
  Shading shading;
  shading.frame = frame;
  material.shade(point, known, shading);
  return shading;
}

void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-6f) << a.x << " " << a.y << " " << a.z; }
void expect_near(Normal3 a, Vec3 b) { expect_near(as_vec(a), b); }
void expect_orthonormal(const Frame& frame) {
  expect_near(cross(as_vec(frame.n), frame.s), frame.t);
  EXPECT_NEAR(length(frame.s), 1, 1e-6f);
  EXPECT_NEAR(dot(frame.s, frame.n), 0, 1e-6f);
}
bool same(const Frame& a, const Frame& b) { return a.s == b.s && a.t == b.t && a.n == b.n; }

TEST(BumpMap, GivesTheNormalOfTheDisplacedPlane) {
  // (2u, 3v, a u + b v) has the normal (-a/2, -b/3, 1).
  for (const Vec2 slope : {Vec2{1, 0}, Vec2{0, 1}, Vec2{-2.5f, 0.7f}, Vec2{50, -3}}) {
    const Frame frame = shade(*bump(slope)).frame;
    expect_near(frame.n, normalize({-slope.x / 2, -slope.y / 3, 1}));
    expect_orthonormal(frame);
    EXPECT_NEAR(frame.s.y * dot(k_plane.dp_du, frame.s) / 2, frame.s.x * frame.s.y, 1e-6f) << "s follows dp/du";
  }
}

TEST(BumpMap, KeepsTheSideWhereUvsAreMirrored) {
  const MaterialPoint mirrored{{}, {2, 0, 0}, {0, -3, 0}};
  expect_near(shade(*bump({1, 1}), mirrored).frame.n, normalize({-0.5f, 1 / 3.0f, 1}));
}

TEST(BumpMap, SlopesRiseAlongTheShadingNormal) {
  const Normal3 n{0.6f, 0, 0.8f};
  const Frame smooth = frame_from_normal_and_tangent(n, k_plane.dp_du);
  const Vec3 along_u = k_plane.dp_du - dot(n, k_plane.dp_du) * as_vec(n);
  const Vec3 expected = normalize(cross(along_u + 0.5f * as_vec(n), k_plane.dp_dv));
  expect_near(shade(*bump({0.5f, 0}), k_plane, k_above, smooth).frame.n, expected);
}

TEST(BumpMap, ScaleMultipliesHeights) {
  expect_near(shade(*bump({1, -2}, 3)).frame.n, normalize({-1.5f, 2, 1}));
  EXPECT_TRUE(same(shade(*bump({1, -2}, 0)).frame, Frame()));
}

TEST(BumpMap, LeavesTheFrameWhereItIsFlatOrHasNoDerivatives) {
  const Frame frame = frame_from_normal(as_normal(normalize({1, 2, 3})));
  EXPECT_TRUE(same(shade(*bump({0, 0}), k_plane, k_above, frame).frame, frame));
  EXPECT_TRUE(same(shade(*bump({1, 1}), {{}, {}, {}}, k_above, {}).frame, Frame()));
  const auto constant = make_bump_map(k_diffuse, Texture(Rgb(0.7f)), 5);
  EXPECT_TRUE(same(shade(*constant, k_plane, k_above, frame).frame, frame));
}

TEST(BumpMap, PassesTheNestedMaterialThrough) {
  const auto material = bump({1, 1});
  EXPECT_EQ(shade(*material).bsdf.albedo(), Rgb(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(material->max_connectable_pi_f({}), 0.75f);
  EXPECT_TRUE(material->needs_derivatives());
  EXPECT_TRUE(material->bends_normals());
  EXPECT_EQ(material->textures().size(), 2u);
  EXPECT_TRUE(make_two_sided(material, material)->bends_normals());
}

TEST(BumpMap, BehindATwoSidedSurfaceIsTheMirrorImageOfItsFront) {
  const MaterialPtr around = make_two_sided(bump({1, 0}), bump({1, 0}));
  expect_near(shade(*around).frame.n, normalize({-0.5f, 0, 1}));
  expect_near(shade(*around, k_plane, k_below).frame.n, normalize({-0.5f, 0, -1}));
}

TEST(BumpMap, AroundATwoSidedMaterialTheBentNormalDividesTheSides) {
  const MaterialPtr inside =
      make_bump_map(make_two_sided(k_diffuse, k_diffuse), Texture(std::make_shared<Ramp>(Vec2{2, 0})), 1);
  const Vec3 bent = normalize({-1, 0, 1});
  expect_near(shade(*inside).frame.n, bent);
  expect_near(shade(*inside, k_plane, k_below).frame.n, -bent);
  expect_near(shade(*inside, k_plane, normalize({1, 0, 0.5f})).frame.n, -bent);
}

TEST(NormalMap, TurnsTheNormalInTheTangentFrame) {
  const Normal3 n{0, 0, 1};
  const MaterialPoint turned{{}, {0, 5, 0}, {-1, 0, 0}};  // s = y, t = -x, whatever frame comes in
  expect_near(shade(*constant_normals({0.6f, 0, 0.8f}), turned, k_above, frame_from_normal(n)).frame.n,
              {0, 0.6f, 0.8f});
  expect_near(shade(*constant_normals({0, 0.6f, 0.8f}), turned).frame.n, {-0.6f, 0, 0.8f});
  expect_orthonormal(shade(*constant_normals({0.48f, 0.6f, 0.64f}), turned).frame);
  expect_near(shade(*constant_normals({0.3f, 0, 0.4f}), turned).frame.n, {0, 0.6f, 0.8f});  // of any length
}

TEST(NormalMap, UprightChangesNothing) {
  const Frame frame = frame_from_normal_and_tangent(as_normal(normalize({1, 2, 3})), k_plane.dp_du);
  const Frame bent = shade(*constant_normals({0, 0, 1}), k_plane, k_above, frame).frame;
  EXPECT_TRUE(same(bent, frame));
}

TEST(NormalMap, StaysOnItsSideOfTheSurface) { EXPECT_GT(shade(*constant_normals({0.6f, 0, -0.8f})).frame.n.z, 0); }

TEST(NormalMap, LeavesTheFrameWithoutDerivativesOrNormal) {
  EXPECT_TRUE(same(shade(*constant_normals({0.6f, 0, 0.8f}), {{}, {}, {}}).frame, Frame()));
  EXPECT_TRUE(same(shade(*constant_normals({0, 0, 0})).frame, Frame()));
}

TEST(NormalMap, OnABumpedSurfaceStartsFromTheBumps) {
  const MaterialPtr both =
      make_bump_map(constant_normals({0.6f, 0, 0.8f}), Texture(std::make_shared<Ramp>(Vec2{2, 0})), 1);
  const Vec3 bent = normalize({-1, 0, 1}), along = normalize({1, 0, 1});
  expect_near(shade(*both).frame.n, 0.6f * along + 0.8f * bent);
}

}  // namespace
}  // namespace gradslc
