#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

class PlasticMaterial final : public Material {
 public:
  PlasticMaterial(float eta, Texture diffuse_reflectance, bool nonlinear, Texture specular_reflectance)
      : coat_{eta, 1 - diffuse_fresnel_reflectance(1 / eta)},
        diffuse_reflectance_(std::move(diffuse_reflectance)),
        nonlinear_(nonlinear),
        specular_reflectance_(std::move(specular_reflectance)) {}

  void shade(const MaterialPoint& point, const Vec3&, Shading& shading) const override {
    shading.bsdf.add(SmoothCoat{{coat_.eta}, specular_reflectance_.eval(point.uv)});
    shading.bsdf.add(SmoothCoatedDiffuse{
        coat_, base_under_coat(diffuse_reflectance_.eval(point.uv), 1 - coat_.escaping_share, nonlinear_)});
  }
  bool has_other_lobes(const LobeSelection&) const override { return true; }
  float max_connectable_pi_f(const LobeSelection&) const override {
    const Rgb base = base_under_coat(diffuse_reflectance_.max_value(), 1 - coat_.escaping_share, nonlinear_);
    return max_channel(base) * coat_.inv_eta2();
  }
  int max_lobes() const override { return 2; }
  std::vector<Texture> textures() const override { return {specular_reflectance_, diffuse_reflectance_}; }

 private:
  SmoothCoatTransmittance coat_;
  Texture diffuse_reflectance_;
  bool nonlinear_;
  Texture specular_reflectance_;
};

}  // namespace

MaterialPtr make_plastic(PropertyReader& properties) {
  const float eta = read_refracting_index(properties, "polypropylene");
  const Texture diffuse = properties.texture("diffuse_reflectance", Rgb(0.5f));
  const bool nonlinear = properties.boolean("nonlinear", false);
  return std::make_shared<PlasticMaterial>(eta, diffuse, nonlinear,
                                           properties.texture("specular_reflectance", Rgb(1.0f)));
}

MaterialPtr make_plastic(float eta, Texture diffuse_reflectance, bool nonlinear) {
  return std::make_shared<PlasticMaterial>(eta, std::move(diffuse_reflectance), nonlinear, Texture(Rgb(1.0f)));
}

}  // namespace gradslc
