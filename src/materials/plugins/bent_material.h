#pragma once

#include <utility>

#include "materials/material.h"

namespace gradslc {

/// A material under a normal that a texture bends; everything else is the nested material's. What scatters across the
/// unbent surface because of it is the caller's to reject (Material::bends_normals()).
class BentMaterial : public Material {
 public:
  BentMaterial(MaterialPtr nested, Texture texture) : nested_(std::move(nested)), texture_(std::move(texture)) {}

  void shade(const MaterialPoint& point, const Vec3& known, Shading& shading) const final {
    shading.frame = bend(point, shading.frame);
    nested_->shade(point, known, shading);
  }
  bool has_other_lobes(const LobeSelection& lobes) const final { return nested_->has_other_lobes(lobes); }
  float max_connectable_pi_f(const LobeSelection& lobes) const final { return nested_->max_connectable_pi_f(lobes); }
  int max_lobes() const final { return nested_->max_lobes(); }
  bool needs_derivatives() const final { return true; }
  bool bends_normals() const final { return true; }
  bool transmits() const final { return nested_->transmits(); }
  bool crosses() const final { return nested_->crosses(); }
  bool turns_frame() const final { return nested_->turns_frame(); }
  std::vector<Texture> textures() const final {
    std::vector<Texture> textures = nested_->textures();
    textures.push_back(texture_);
    return textures;
  }

 protected:
  /// The bent frame: n on the side of the unbent one, s along dp/du.
  virtual Frame bend(const MaterialPoint& point, const Frame& frame) const = 0;
  const Texture& texture() const { return texture_; }

 private:
  MaterialPtr nested_;
  Texture texture_;
};

}  // namespace gradslc
