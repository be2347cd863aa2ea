#include "materials/plugins.h"

namespace gradslc {
namespace {

class DiffuseMaterial final : public Material {
 public:
  explicit DiffuseMaterial(Texture reflectance) : reflectance_(std::move(reflectance)) {}

  void shade(const MaterialPoint& point, const Vec3&, Shading& shading) const override {
    shading.bsdf.add(Lambert{reflectance_.eval(point.uv)});
  }
  bool has_other_lobes(const LobeSelection& lobes) const override { return !lobes.is_connectable(k_diffuse_roughness); }
  float max_connectable_pi_f(const LobeSelection&) const override { return max_channel(reflectance_.max_value()); }
  std::vector<Texture> textures() const override { return {reflectance_}; }

 private:
  Texture reflectance_;
};

}  // namespace

MaterialPtr make_diffuse(PropertyReader& properties) {
  return make_diffuse(properties.texture("reflectance", Rgb(0.5f)));
}

MaterialPtr make_diffuse(Texture reflectance) { return std::make_shared<DiffuseMaterial>(std::move(reflectance)); }

}  // namespace gradslc
