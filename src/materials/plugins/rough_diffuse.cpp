#include <algorithm>

#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

class RoughDiffuseMaterial final : public Material {
 public:
  RoughDiffuseMaterial(Texture reflectance, Texture alpha, bool fast_approximation)
      : reflectance_(std::move(reflectance)), alpha_(std::move(alpha)), fast_approximation_(fast_approximation) {}

  void shade(const MaterialPoint& point, const Vec3&, Shading& shading) const override {
    shading.bsdf.add(OrenNayar(reflectance_.eval(point.uv), mean_channel(alpha_.eval(point.uv)), fast_approximation_));
  }
  bool has_other_lobes(const LobeSelection& lobes) const override { return !lobes.is_connectable(k_diffuse_roughness); }
  float max_connectable_pi_f(const LobeSelection&) const override {
    // Largest where known grazes; all of the model's terms but the first, which is at most 1, grow with alpha.
    const OrenNayar roughest(Rgb(max_channel(reflectance_.max_value())), mean_channel(alpha_.max_value()),
                             fast_approximation_);
    return max_channel(reflectance_.max_value()) + roughest.max_pi_f({1, 0, k_grazing});
  }
  std::vector<Texture> textures() const override { return {reflectance_, alpha_}; }

 private:
  static constexpr float k_grazing = 1e-6f;
  Texture reflectance_, alpha_;
  bool fast_approximation_;
};

}  // namespace

MaterialPtr make_rough_diffuse(PropertyReader& properties) {
  const char* name = properties.has("diffuse_reflectance") ? "diffuse_reflectance" : "reflectance";
  const Texture reflectance = properties.texture(name, Rgb(0.5f));
  const Texture alpha = properties.texture("alpha", Rgb(0.2f));
  if (mean_channel(alpha.min_value()) < 0) properties.fail("alpha", "a roughness must not be negative");
  return std::make_shared<RoughDiffuseMaterial>(reflectance, alpha, properties.boolean("use_fast_approx", false));
}

}  // namespace gradslc
