#include "materials/plugins.h"
#include "materials/plugins/bent_material.h"

namespace gradslc {
namespace {

/// Normals in the shading frame, s along dp/du and t = n x s, each coordinate x stored as (x + 1) / 2.
class NormalMap final : public BentMaterial {
 public:
  using BentMaterial::BentMaterial;

 private:
  Frame bend(const MaterialPoint& point, const Frame& frame) const override {
    if (point.dp_du == Vec3()) return frame;
    const Rgb stored = texture().eval(point.uv);
    const Vec3 local{2 * stored.r - 1, 2 * stored.g - 1, 2 * stored.b - 1};
    const float squared = length_squared(local);
    if (!(squared > 0)) return frame;
    const Frame tangent = frame_from_normal_and_tangent(frame.n, point.dp_du);
    const Vec3 bent = tangent.to_world(local / std::sqrt(squared));
    return frame_from_normal_and_tangent(face_forward(as_normal(bent), as_vec(frame.n)), point.dp_du);
  }
};

}  // namespace

MaterialPtr make_normal_map(PropertyReader& properties) {
  const std::vector<Texture> textures = properties.nested_textures();
  const std::vector<MaterialPtr> nested = properties.nested_materials();
  if (textures.size() != 1 || nested.size() != 1)
    properties.fail("", "a normalmap needs one texture and one bsdf inside");
  return make_normal_map(nested.front(), textures.front());
}

MaterialPtr make_normal_map(MaterialPtr nested, Texture normals) {
  return std::make_shared<NormalMap>(std::move(nested), std::move(normals));
}

}  // namespace gradslc
