#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

class DielectricMaterial final : public Material {
 public:
  DielectricMaterial(float eta, Texture reflectance, Texture transmittance)
      : eta_(eta), reflectance_(std::move(reflectance)), transmittance_(std::move(transmittance)) {}

  void shade(const MaterialPoint& point, const Vec3&, Shading& shading) const override {
    shading.bsdf.add(SmoothDielectric{eta_, reflectance_.eval(point.uv), transmittance_.eval(point.uv)});
  }
  bool has_other_lobes(const LobeSelection&) const override { return true; }
  float max_connectable_pi_f(const LobeSelection&) const override { return 0; }
  bool transmits() const override { return true; }
  std::vector<Texture> textures() const override { return {reflectance_, transmittance_}; }

 private:
  float eta_;
  Texture reflectance_, transmittance_;
};

}  // namespace

MaterialPtr make_dielectric(PropertyReader& properties) {
  const float eta = read_relative_index(properties, "bk7");
  const Texture reflectance = properties.texture("specular_reflectance", Rgb(1.0f));
  return std::make_shared<DielectricMaterial>(eta, reflectance,
                                              properties.texture("specular_transmittance", Rgb(1.0f)));
}

MaterialPtr make_dielectric(float eta) {
  return std::make_shared<DielectricMaterial>(eta, Texture(Rgb(1.0f)), Texture(Rgb(1.0f)));
}

}  // namespace gradslc
