#include "materials/plugins.h"
#include "materials/plugins/bent_material.h"

namespace gradslc {
namespace {

/// A height field over uv, in scene units. As in Mitsuba 0.6 and 3, its slopes take the place of the derivatives' parts
/// along the shading normal, and how the normal itself turns is left out (after Blinn 1978).
class BumpMap final : public BentMaterial {
 public:
  BumpMap(MaterialPtr nested, Texture height, float scale)
      : BentMaterial(std::move(nested), std::move(height)), scale_(scale) {}

 private:
  Frame bend(const MaterialPoint& point, const Frame& frame) const override {
    const Vec2 slope = scale_ * texture().gradient(point.uv);
    if (slope.x == 0 && slope.y == 0) return frame;
    const Vec3 n = as_vec(frame.n);
    const Vec3 dp_du = point.dp_du + (slope.x - dot(n, point.dp_du)) * n;
    const Vec3 dp_dv = point.dp_dv + (slope.y - dot(n, point.dp_dv)) * n;
    const Vec3 normal = cross(dp_du, dp_dv);
    const float squared = length_squared(normal);
    if (!(squared > 0) || !std::isfinite(squared)) return frame;  // no derivatives
    const Normal3 bent = face_forward(as_normal(normal / std::sqrt(squared)), n);
    return frame_from_normal_and_tangent(bent, point.dp_du);
  }

  float scale_;
};

}  // namespace

MaterialPtr make_bump_map(PropertyReader& properties) {
  const float scale = properties.real("scale", 1);
  const std::vector<Texture> textures = properties.nested_textures();
  const std::vector<MaterialPtr> nested = properties.nested_materials();
  if (textures.size() != 1 || nested.size() != 1)
    properties.fail("", "a bumpmap needs one texture and one bsdf inside");
  return make_bump_map(nested.front(), textures.front(), scale);
}

MaterialPtr make_bump_map(MaterialPtr nested, Texture height, float scale) {
  return std::make_shared<BumpMap>(std::move(nested), std::move(height), scale);
}

}  // namespace gradslc
