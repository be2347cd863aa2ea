#include <algorithm>

#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

class RoughDielectricMaterial final : public Material {
 public:
  RoughDielectricMaterial(MicrofacetTextures microfacets, float eta, Texture reflectance, Texture transmittance)
      : microfacets_(std::move(microfacets)),
        eta_(eta),
        reflectance_(std::move(reflectance)),
        transmittance_(std::move(transmittance)) {}

  void shade(const MaterialPoint& point, const Vec3&, Shading& shading) const override {
    shading.bsdf.add(
        RoughDielectric{microfacets_.at(point.uv), eta_, reflectance_.eval(point.uv), transmittance_.eval(point.uv)});
  }
  bool has_other_lobes(const LobeSelection& lobes) const override {
    return !lobes.is_connectable(microfacets_.min_alpha());
  }
  float max_connectable_pi_f(const LobeSelection& lobes) const override {
    const float reflected = max_channel(reflectance_.max_value()) * k_pi / 4;
    const float refracted = max_channel(transmittance_.max_value()) * RoughDielectric::max_refraction(eta_);
    return std::max(reflected, refracted) * microfacets_.max_facets(lobes.connectable_roughness);
  }
  bool needs_derivatives() const override { return microfacets_.anisotropic(); }
  bool transmits() const override { return true; }
  std::vector<Texture> textures() const override {
    return joined(microfacets_.textures(), {reflectance_, transmittance_});
  }

 private:
  MicrofacetTextures microfacets_;
  float eta_;
  Texture reflectance_, transmittance_;
};

}  // namespace

MaterialPtr make_rough_dielectric(PropertyReader& properties) {
  MicrofacetTextures microfacets = read_microfacets(properties);
  const float eta = read_refracting_index(properties, "bk7");
  const Texture reflectance = properties.texture("specular_reflectance", Rgb(1.0f));
  return std::make_shared<RoughDielectricMaterial>(std::move(microfacets), eta, reflectance,
                                                   properties.texture("specular_transmittance", Rgb(1.0f)));
}

MaterialPtr make_rough_dielectric(MicrofacetType type, float alpha, float eta) {
  return std::make_shared<RoughDielectricMaterial>(MicrofacetTextures{type, Texture(Rgb(alpha)), Texture(Rgb(alpha))},
                                                   eta, Texture(Rgb(1.0f)), Texture(Rgb(1.0f)));
}

}  // namespace gradslc
