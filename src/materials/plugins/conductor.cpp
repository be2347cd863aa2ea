#include "materials/plugins.h"

namespace gradslc {
namespace {

class ConductorMaterial final : public Material {
 public:
  ConductorMaterial(Rgb eta, Rgb k, Texture specular_reflectance)
      : eta_(eta), k_(k), specular_reflectance_(std::move(specular_reflectance)) {}

  void shade(const MaterialPoint& point, Vec3, Shading& shading) const override {
    shading.bsdf.add(SmoothConductor{eta_, k_, specular_reflectance_.eval(point.uv)});
  }
  bool has_other_lobes(const LobeSelection&) const override { return true; }
  float max_connectable_pi_f(const LobeSelection&) const override { return 0; }
  std::vector<Texture> textures() const override { return {specular_reflectance_}; }

 private:
  Rgb eta_, k_;
  Texture specular_reflectance_;
};

}  // namespace

MaterialPtr make_conductor(PropertyReader& properties) {
  const std::string preset = properties.text("material", "");
  if (!preset.empty() && preset != "none")
    properties.fail("material", "only material \"none\" (a perfect mirror) is known; give eta and k instead");
  const bool mirror = preset == "none";
  const Rgb eta = properties.colour("eta", mirror ? Rgb(0.0f) : Rgb(0.2004f, 0.9240f, 1.1022f));  // copper
  const Rgb k = properties.colour("k", mirror ? Rgb(1.0f) : Rgb(3.9129f, 2.4528f, 2.1421f));
  return std::make_shared<ConductorMaterial>(eta, k, properties.texture("specular_reflectance", Rgb(1.0f)));
}

MaterialPtr make_mirror(Texture specular_reflectance) {
  return std::make_shared<ConductorMaterial>(Rgb(0.0f), Rgb(1.0f), std::move(specular_reflectance));
}

}  // namespace gradslc
