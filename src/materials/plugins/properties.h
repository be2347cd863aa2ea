#pragma once
// What several BSDF plug-ins read from their properties alike.

#include <string_view>

#include "materials/microfacet.h"
#include "materials/property_reader.h"
#include "materials/refractive_indices.h"

namespace gradslc {

/// "int_ior" over "ext_ior", numbers or names; > 0. `default_interior` is a name.
float read_relative_index(PropertyReader& properties, std::string_view default_interior);
/// The same where the interface must refract: an error if both are equal.
float read_refracting_index(PropertyReader& properties, std::string_view default_interior);

/// "material" or "eta" and "k", divided by "ext_eta".
ConductorIndex read_conductor(PropertyReader& properties);

/// A distribution of facets whose roughness may be textured.
struct MicrofacetTextures {
  MicrofacetType type = MicrofacetType::beckmann;
  Texture alpha_u, alpha_v;

  Microfacet at(Vec2 uv) const;
  bool anisotropic() const;
  /// The sharpest and the widest roughness of any direction anywhere.
  float min_alpha() const;
  float max_alpha() const;
  /// Upper bound of D G1 G1 / (cos cos) for all directions at points where the lobe is connectable; 0 where it never
  /// is.
  float max_facets(float connectable_roughness) const;
  std::vector<Texture> textures() const { return {alpha_u, alpha_v}; }
};
/// "distribution", "alpha" or "alpha_u" and "alpha_v"; "sample_visible" has no effect: visible normals always are.
MicrofacetTextures read_microfacets(PropertyReader& properties);
/// The same without textures and anisotropy.
Microfacet read_isotropic_microfacet(PropertyReader& properties);

/// Diffuse reflectance of the base of a coat that throws `internal_reflectance` of its light back to it, over and over:
/// with the base's own colour at each return where `nonlinear`, else without it (Mitsuba's plastic).
Rgb base_under_coat(Rgb diffuse_reflectance, float internal_reflectance, bool nonlinear);

/// Value of a texture that stands for one number.
float mean_channel(Rgb value);
/// `more` behind `textures`.
std::vector<Texture> joined(std::vector<Texture> textures, const std::vector<Texture>& more);

}  // namespace gradslc
