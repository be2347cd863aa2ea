#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

class RoughConductorMaterial final : public Material {
 public:
  RoughConductorMaterial(MicrofacetTextures microfacets, const ConductorIndex& index, Texture specular_reflectance)
      : microfacets_(std::move(microfacets)),
        term_{index.eta, index.k},
        specular_reflectance_(std::move(specular_reflectance)) {}

  void shade(const MaterialPoint& point, const Vec3&, Shading& shading) const override {
    shading.bsdf.add(RoughConductor{microfacets_.at(point.uv), term_, specular_reflectance_.eval(point.uv)});
  }
  bool has_other_lobes(const LobeSelection& lobes) const override {
    return !lobes.is_connectable(microfacets_.min_alpha());
  }
  float max_connectable_pi_f(const LobeSelection& lobes) const override {
    return k_pi / 4 * max_channel(specular_reflectance_.max_value()) *
           microfacets_.max_facets(lobes.connectable_roughness);
  }
  bool needs_derivatives() const override { return microfacets_.anisotropic(); }
  std::vector<Texture> textures() const override { return joined(microfacets_.textures(), {specular_reflectance_}); }

 private:
  MicrofacetTextures microfacets_;
  ConductorTerm term_;
  Texture specular_reflectance_;
};

}  // namespace

MaterialPtr make_rough_conductor(PropertyReader& properties) {
  MicrofacetTextures microfacets = read_microfacets(properties);
  const ConductorIndex index = read_conductor(properties);
  return std::make_shared<RoughConductorMaterial>(std::move(microfacets), index,
                                                  properties.texture("specular_reflectance", Rgb(1.0f)));
}

MaterialPtr make_rough_mirror(MicrofacetType type, float alpha, Texture specular_reflectance) {
  return std::make_shared<RoughConductorMaterial>(MicrofacetTextures{type, Texture(Rgb(alpha)), Texture(Rgb(alpha))},
                                                  ConductorIndex{Rgb(0.0f), Rgb(1.0f)},
                                                  std::move(specular_reflectance));
}

}  // namespace gradslc
