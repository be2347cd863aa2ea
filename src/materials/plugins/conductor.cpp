#include "materials/plugins.h"
#include "materials/plugins/properties.h"

namespace gradslc {
namespace {

class ConductorMaterial final : public Material {
 public:
  ConductorMaterial(const ConductorIndex& index, Texture specular_reflectance)
      : term_{index.eta, index.k}, specular_reflectance_(std::move(specular_reflectance)) {}

  void shade(const MaterialPoint& point, const Vec3&, Shading& shading) const override {
    shading.bsdf.add(SmoothConductor{term_, specular_reflectance_.eval(point.uv)});
  }
  bool has_other_lobes(const LobeSelection&) const override { return true; }
  float max_connectable_pi_f(const LobeSelection&) const override { return 0; }
  std::vector<Texture> textures() const override { return {specular_reflectance_}; }

 private:
  ConductorTerm term_;
  Texture specular_reflectance_;
};

}  // namespace

MaterialPtr make_conductor(PropertyReader& properties) {
  const ConductorIndex index = read_conductor(properties);
  return std::make_shared<ConductorMaterial>(index, properties.texture("specular_reflectance", Rgb(1.0f)));
}

MaterialPtr make_mirror(Texture specular_reflectance) {
  return std::make_shared<ConductorMaterial>(ConductorIndex{Rgb(0.0f), Rgb(1.0f)}, std::move(specular_reflectance));
}

}  // namespace gradslc
