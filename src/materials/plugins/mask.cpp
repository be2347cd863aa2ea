#include <algorithm>

#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

Rgb clamped(Rgb c) { return {std::clamp(c.r, 0.0f, 1.0f), std::clamp(c.g, 0.0f, 1.0f), std::clamp(c.b, 0.0f, 1.0f)}; }

/// The nested BSDF times the opacity; the rest of the light passes straight through.
class MaskMaterial final : public Material {
 public:
  MaskMaterial(Texture opacity, MaterialPtr nested) : opacity_(std::move(opacity)), nested_(std::move(nested)) {}

  void shade(const MaterialPoint& point, const Vec3& known, Shading& shading) const override {
    const Rgb opacity = clamped(opacity_.eval(point.uv));
    if (!is_black(opacity)) {
      Shading opaque{shading.frame, {}};
      nested_->shade(point, known, opaque);
      shading.frame = opaque.frame;
      shading.bsdf.add(opaque.bsdf, opacity);
    }
    shading.bsdf.add_straight_transmittance(Rgb(1) - opacity);
  }
  bool has_other_lobes(const LobeSelection& lobes) const override { return nested_->has_other_lobes(lobes); }
  float max_connectable_pi_f(const LobeSelection& lobes) const override {
    return max_channel(clamped(opacity_.max_value())) * nested_->max_connectable_pi_f(lobes);
  }
  int max_lobes() const override { return nested_->max_lobes(); }
  bool needs_derivatives() const override { return nested_->needs_derivatives(); }
  bool bends_normals() const override { return nested_->bends_normals(); }
  bool transmits() const override { return true; }
  bool crosses() const override { return clamped(opacity_.min_value()) != Rgb(1) || nested_->crosses(); }
  bool turns_frame() const override { return nested_->turns_frame(); }
  std::vector<Texture> textures() const override { return joined({opacity_}, nested_->textures()); }

 private:
  Texture opacity_;
  MaterialPtr nested_;
};

}  // namespace

MaterialPtr make_mask(PropertyReader& properties) {
  const Texture opacity = properties.texture("opacity", Rgb(0.5f));
  const std::vector<MaterialPtr> nested = properties.nested_materials();
  if (nested.size() != 1) properties.fail("", "a mask needs one bsdf inside");
  return make_mask(opacity, nested.front());
}

MaterialPtr make_mask(Texture opacity, MaterialPtr nested) {
  return std::make_shared<MaskMaterial>(std::move(opacity), std::move(nested));
}

}  // namespace gradslc
