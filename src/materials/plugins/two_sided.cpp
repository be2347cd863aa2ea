#include <algorithm>

#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

/// One BSDF in front, another (or the same one) behind, mirrored at the surface.
class TwoSidedMaterial final : public Material {
 public:
  TwoSidedMaterial(MaterialPtr front, MaterialPtr back) : front_(std::move(front)), back_(std::move(back)) {}

  void shade(const MaterialPoint& point, const Vec3& known, Shading& shading) const override {
    const Vec3 n = as_vec(shading.frame.n);
    if (dot(known, n) >= 0) {
      front_->shade(point, known, shading);
      return;
    }
    const auto mirrored = [n](const Vec3& v) { return v - 2 * dot(v, n) * n; };
    back_->shade(point, mirrored(known), shading);
    shading.frame = {mirrored(shading.frame.s), mirrored(shading.frame.t),
                     as_normal(mirrored(as_vec(shading.frame.n)))};
  }
  bool has_other_lobes(const LobeSelection& lobes) const override {
    return front_->has_other_lobes(lobes) || back_->has_other_lobes(lobes);
  }
  float max_connectable_pi_f(const LobeSelection& lobes) const override {
    return std::max(front_->max_connectable_pi_f(lobes), back_->max_connectable_pi_f(lobes));
  }
  int max_lobes() const override { return std::max(front_->max_lobes(), back_->max_lobes()); }
  bool needs_derivatives() const override { return front_->needs_derivatives() || back_->needs_derivatives(); }
  bool bends_normals() const override { return front_->bends_normals() || back_->bends_normals(); }
  bool turns_frame() const override { return true; }
  std::vector<Texture> textures() const override {
    return back_ == front_ ? front_->textures() : joined(front_->textures(), back_->textures());
  }

 private:
  MaterialPtr front_, back_;
};

}  // namespace

MaterialPtr make_two_sided(PropertyReader& properties) {
  const std::vector<MaterialPtr> nested = properties.nested_materials();
  if (nested.empty() || nested.size() > 2)
    properties.fail("", "a twosided bsdf needs one bsdf inside, or two (front and back)");
  if (nested.front()->transmits() || nested.back()->transmits())
    properties.fail("", "a twosided bsdf must not hold one that transmits light");
  return make_two_sided(nested.front(), nested.back());
}

MaterialPtr make_two_sided(MaterialPtr front, MaterialPtr back) {
  return std::make_shared<TwoSidedMaterial>(std::move(front), std::move(back));
}

}  // namespace gradslc
