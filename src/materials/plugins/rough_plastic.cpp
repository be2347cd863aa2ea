#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

class RoughPlasticMaterial final : public Material {
 public:
  RoughPlasticMaterial(const Microfacet& microfacet, float eta, Texture diffuse_reflectance, bool nonlinear,
                       Texture specular_reflectance)
      : microfacet_(microfacet),
        eta_(eta),
        transmittance_(microfacet, eta),
        diffuse_reflectance_(std::move(diffuse_reflectance)),
        nonlinear_(nonlinear),
        specular_reflectance_(std::move(specular_reflectance)) {}

  void shade(const MaterialPoint& point, const Vec3&, Shading& shading) const override {
    shading.bsdf.add(RoughCoat{microfacet_, {eta_}, specular_reflectance_.eval(point.uv)});
    shading.bsdf.add(RoughCoatedDiffuse{{&transmittance_}, base(diffuse_reflectance_.eval(point.uv))});
  }
  bool has_other_lobes(const LobeSelection& lobes) const override {
    return !lobes.is_connectable(microfacet_.roughness());
  }
  float max_connectable_pi_f(const LobeSelection& lobes) const override {
    const float diffuse = max_channel(base(diffuse_reflectance_.max_value())) * transmittance_.inv_eta2() *
                          transmittance_.max() * transmittance_.max();
    if (!lobes.is_connectable(microfacet_.roughness())) return diffuse;
    const MicrofacetTextures constant{microfacet_.type, Texture(Rgb(microfacet_.alpha_u)),
                                      Texture(Rgb(microfacet_.alpha_v))};
    return diffuse +
           k_pi / 4 * max_channel(specular_reflectance_.max_value()) * constant.max_facets(lobes.connectable_roughness);
  }
  int max_lobes() const override { return 2; }
  std::vector<Texture> textures() const override { return {specular_reflectance_, diffuse_reflectance_}; }

 private:
  Rgb base(Rgb diffuse) const { return base_under_coat(diffuse, 1 - transmittance_.escaping(), nonlinear_); }

  Microfacet microfacet_;
  float eta_;
  RoughTransmittance transmittance_;
  Texture diffuse_reflectance_;
  bool nonlinear_;
  Texture specular_reflectance_;
};

}  // namespace

MaterialPtr make_rough_plastic(PropertyReader& properties) {
  const Microfacet microfacet = read_isotropic_microfacet(properties);
  const float eta = read_refracting_index(properties, "polypropylene");
  const Texture diffuse = properties.texture("diffuse_reflectance", Rgb(0.5f));
  const bool nonlinear = properties.boolean("nonlinear", false);
  return std::make_shared<RoughPlasticMaterial>(microfacet, eta, diffuse, nonlinear,
                                                properties.texture("specular_reflectance", Rgb(1.0f)));
}

MaterialPtr make_rough_plastic(MicrofacetType type, float alpha, float eta, Texture diffuse_reflectance,
                               bool nonlinear) {
  return std::make_shared<RoughPlasticMaterial>(Microfacet::make(type, alpha, alpha), eta,
                                                std::move(diffuse_reflectance), nonlinear, Texture(Rgb(1.0f)));
}

}  // namespace gradslc
