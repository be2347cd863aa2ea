#include <algorithm>

#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

/// (1 - weight) of one BSDF and weight of another.
class BlendMaterial final : public Material {
 public:
  BlendMaterial(Texture weight, MaterialPtr first, MaterialPtr second)
      : weight_(std::move(weight)), first_(std::move(first)), second_(std::move(second)) {}

  void shade(const MaterialPoint& point, const Vec3& known, Shading& shading) const override {
    const float weight = std::clamp(mean_channel(weight_.eval(point.uv)), 0.0f, 1.0f);
    Shading first{shading.frame, {}}, second{shading.frame, {}};
    if (weight < 1) first_->shade(point, known, first);
    if (weight > 0) second_->shade(point, known, second);
    // Seen from behind, where only one of them is two-sided, the other one is black.
    const bool behind = dot(known, shading.frame.n) < 0 && first_->turns_frame() != second_->turns_frame();
    if (behind) shading.frame = first_->turns_frame() ? first.frame : second.frame;
    if (!behind || first_->turns_frame()) shading.bsdf.add(first.bsdf, Rgb(1 - weight));
    if (!behind || second_->turns_frame()) shading.bsdf.add(second.bsdf, Rgb(weight));
    if (!behind) shading.frame = weight < 1 ? first.frame : second.frame;
  }
  bool has_other_lobes(const LobeSelection& lobes) const override {
    return first_->has_other_lobes(lobes) || second_->has_other_lobes(lobes);
  }
  float max_connectable_pi_f(const LobeSelection& lobes) const override {
    const auto between = [](Rgb weight) { return std::clamp(mean_channel(weight), 0.0f, 1.0f); };
    return (1 - between(weight_.min_value())) * first_->max_connectable_pi_f(lobes) +
           between(weight_.max_value()) * second_->max_connectable_pi_f(lobes);
  }
  int max_lobes() const override { return first_->max_lobes() + second_->max_lobes(); }
  bool needs_derivatives() const override { return first_->needs_derivatives() || second_->needs_derivatives(); }
  bool transmits() const override { return first_->transmits() || second_->transmits(); }
  bool crosses() const override { return first_->crosses() || second_->crosses(); }
  bool turns_frame() const override { return first_->turns_frame() || second_->turns_frame(); }
  std::vector<Texture> textures() const override {
    return joined(joined({weight_}, first_->textures()), second_->textures());
  }

 private:
  Texture weight_;
  MaterialPtr first_, second_;
};

}  // namespace

MaterialPtr make_blend(PropertyReader& properties) {
  const Texture weight = properties.texture("weight", Rgb(0.5f));
  const std::vector<MaterialPtr> nested = properties.nested_materials();
  if (nested.size() != 2) properties.fail("", "a blendbsdf needs two bsdfs inside");
  const Material &first = *nested[0], &second = *nested[1];
  if (first.max_lobes() + second.max_lobes() > static_cast<int>(Bsdf::k_max_lobes))
    properties.fail("", "the bsdfs inside this blendbsdf have too many layers together");
  if (first.bends_normals() || second.bends_normals())
    properties.fail("", "bump and normal maps inside a blendbsdf are not supported; put one around it");
  if ((first.turns_frame() && !second.turns_frame() && second.transmits()) ||
      (second.turns_frame() && !first.turns_frame() && first.transmits()))
    properties.fail("", "a blendbsdf cannot mix a twosided bsdf with one that transmits light");
  return std::make_shared<BlendMaterial>(weight, nested[0], nested[1]);
}

}  // namespace gradslc
