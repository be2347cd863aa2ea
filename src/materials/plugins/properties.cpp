#include "materials/plugins/properties.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "core/error.h"

namespace gradslc {
namespace {

float read_index(PropertyReader& properties, std::string_view name, std::string_view default_name) {
  float index = 0;
  if (properties.has(name) && !properties.is_text(name)) {
    index = properties.real(name, 1);
  } else {
    const std::string dielectric = properties.text(name, default_name);
    const std::optional<float> known = dielectric_index(dielectric);
    if (!known)
      properties.fail(name, "unknown dielectric \"" + dielectric + "\"" + suggestion(dielectric, dielectric_names()));
    index = *known;
  }
  if (!(index > 0)) properties.fail(name, "an index of refraction must be positive");
  return index;
}

MicrofacetType read_distribution(PropertyReader& properties) {
  std::string name = properties.text("distribution", "beckmann");
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (name == "beckmann") return MicrofacetType::beckmann;
  if (name != "ggx")
    properties.fail("distribution", "distribution \"" + name + "\" is not supported; known: beckmann, ggx");
  return MicrofacetType::ggx;
}

}  // namespace

float read_relative_index(PropertyReader& properties, std::string_view default_interior) {
  const float interior = read_index(properties, "int_ior", default_interior);
  return interior / read_index(properties, "ext_ior", "air");
}

float read_refracting_index(PropertyReader& properties, std::string_view default_interior) {
  const float eta = read_relative_index(properties, default_interior);
  if (eta == 1) properties.fail("int_ior", "int_ior and ext_ior must differ");
  return eta;
}

ConductorIndex read_conductor(PropertyReader& properties) {
  const std::string name = properties.text("material", "Cu");
  const std::optional<ConductorIndex> known = conductor_index(name);
  if (!known) properties.fail("material", "unknown conductor \"" + name + "\"" + suggestion(name, conductor_names()));
  const float outside = read_index(properties, "ext_eta", "air");
  return {properties.colour("eta", known->eta) / outside, properties.colour("k", known->k) / outside};
}

Microfacet MicrofacetTextures::at(Vec2 uv) const {
  return Microfacet::make(type, mean_channel(alpha_u.eval(uv)), mean_channel(alpha_v.eval(uv)));
}

bool MicrofacetTextures::anisotropic() const {
  if (alpha_u.map() || alpha_v.map()) return alpha_u.map() != alpha_v.map();
  return mean_channel(alpha_u.eval({})) != mean_channel(alpha_v.eval({}));
}

float MicrofacetTextures::min_alpha() const {
  return std::max(std::min(mean_channel(alpha_u.min_value()), mean_channel(alpha_v.min_value())),
                  Microfacet::k_min_alpha);
}

float MicrofacetTextures::max_alpha() const {
  return std::max(std::max(mean_channel(alpha_u.max_value()), mean_channel(alpha_v.max_value())),
                  Microfacet::k_min_alpha);
}

float MicrofacetTextures::max_facets(float connectable_roughness) const {
  const float narrow = std::max(min_alpha(), connectable_roughness), wide = max_alpha();
  const float roughest = std::min(mean_channel(alpha_u.max_value()), mean_channel(alpha_v.max_value()));
  if (std::max(roughest, Microfacet::k_min_alpha) < connectable_roughness) return 0;
  // Both roughnesses lie between narrow and wide: the density is highest where the surface is flat and narrow, but for
  // facets off the normal where it is wide.
  const Microfacet narrowest{type, narrow, narrow}, widest{type, wide, wide};
  const float density = widest.max_d(0) * (wide * wide) / (narrow * narrow);
  const float masking = narrowest.max_g1_over_cos(0, 1);
  return density * masking * masking * 1.0005f;
}

MicrofacetTextures read_microfacets(PropertyReader& properties) {
  MicrofacetTextures microfacets{read_distribution(properties), Texture(Rgb(0.1f)), Texture(Rgb(0.1f))};
  const bool given_u = properties.has("alpha_u"), given_v = properties.has("alpha_v");
  if (given_u != given_v)
    properties.fail(given_u ? "alpha_u" : "alpha_v", "alpha_u and alpha_v must be given together");
  if (given_u && properties.has("alpha")) properties.fail("alpha", "give either alpha or alpha_u and alpha_v");
  if (given_u) {
    microfacets.alpha_u = properties.texture("alpha_u", Rgb(0.1f));
    microfacets.alpha_v = properties.texture("alpha_v", Rgb(0.1f));
  } else {
    microfacets.alpha_u = microfacets.alpha_v = properties.texture("alpha", Rgb(0.1f));
  }
  if (mean_channel(microfacets.alpha_u.min_value()) < 0 || mean_channel(microfacets.alpha_v.min_value()) < 0)
    properties.fail(given_u ? "alpha_u" : "alpha", "a roughness must not be negative");
  properties.ignore("sample_visible");
  return microfacets;
}

Microfacet read_isotropic_microfacet(PropertyReader& properties) {
  const MicrofacetType type = read_distribution(properties);
  const float alpha = properties.real("alpha", 0.1f);
  if (!(alpha >= 0)) properties.fail("alpha", "a roughness must not be negative");
  properties.ignore("sample_visible");
  return Microfacet::make(type, alpha, alpha);
}

Rgb base_under_coat(Rgb diffuse_reflectance, float internal_reflectance, bool nonlinear) {
  const auto channel = [&](float rho) { return rho / (1 - (nonlinear ? rho : 1) * internal_reflectance); };
  return {channel(diffuse_reflectance.r), channel(diffuse_reflectance.g), channel(diffuse_reflectance.b)};
}

float mean_channel(Rgb value) { return (value.r + value.g + value.b) / 3; }

std::vector<Texture> joined(std::vector<Texture> textures, const std::vector<Texture>& more) {
  textures.insert(textures.end(), more.begin(), more.end());
  return textures;
}

}  // namespace gradslc
