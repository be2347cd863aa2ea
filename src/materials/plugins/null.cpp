#include "materials/plugins.h"

namespace gradslc {
namespace {

/// A surface that is not there.
class NullMaterial final : public Material {
 public:
  void shade(const MaterialPoint&, const Vec3&, Shading& shading) const override {
    shading.bsdf.add_straight_transmittance(Rgb(1));
  }
  bool has_other_lobes(const LobeSelection&) const override { return false; }
  float max_connectable_pi_f(const LobeSelection&) const override { return 0; }
  bool transmits() const override { return true; }
  bool crosses() const override { return true; }
};

}  // namespace

MaterialPtr make_null(PropertyReader&) { return std::make_shared<NullMaterial>(); }

}  // namespace gradslc
