// Plug-ins as scene files make them: names, defaults, errors.

#include "materials/material.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "materials/plugins.h"
#include "materials/refractive_indices.h"
#include "unit/materials/fake_properties.h"

namespace gradslc {
namespace {

constexpr Vec3 k_up{0, 0, 1}, k_down{0, 0, -1};

Rgb albedo(const MaterialPtr& material, Vec3 known = k_up) { return shade(*material, known).bsdf.albedo(); }

TEST(BsdfRegistry, NamesAreUnique) {
  std::set<std::string> names;
  for (const BsdfEntry& entry : bsdf_registry()) EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
}

TEST(DiffuseMaterial, HasTheFormatsDefaultAndTakesItsReflectance) {
  const Bsdf grey = shade(*make_plugin("diffuse"), k_up).bsdf;
  EXPECT_EQ(grey.albedo(), Rgb(0.5f));
  EXPECT_TRUE(grey.lambert_albedo({0, 0, 1}, LobeSelection()).has_value());
  FakeProperties red;
  red.colours["reflectance"] = Rgb(0.9f, 0.1f, 0);
  const MaterialPtr material = make_plugin("diffuse", red);
  EXPECT_EQ(albedo(material), Rgb(0.9f, 0.1f, 0));
  EXPECT_FALSE(material->turns_frame());
  EXPECT_EQ(material->max_connectable_pi_f(LobeSelection()), 0.9f);
  EXPECT_FALSE(material->has_other_lobes(LobeSelection()));
}

TEST(ConductorMaterial, IsCopperByDefaultAndAMirrorByName) {
  const auto reflectance = [&](const MaterialPtr& material) {
    return shade(*material, k_up).bsdf.sample(k_up, 0, {}, LobeSelection()).value().weight;
  };
  const Rgb copper = reflectance(make_plugin("conductor"));
  EXPECT_TRUE(copper.r > 0.9f && copper.g > 0.5f && copper.g < 0.7f && copper.b < copper.g);
  FakeProperties none;
  none.texts["material"] = "none";
  EXPECT_EQ(reflectance(make_plugin("conductor", none)), Rgb(1));
  FakeProperties silver;
  silver.texts["material"] = "Ag";
  EXPECT_GT(reflectance(make_plugin("conductor", silver)).g, 0.9f);
  EXPECT_TRUE(make_plugin("conductor")->has_other_lobes(LobeSelection()));
  EXPECT_EQ(make_plugin("conductor")->max_connectable_pi_f(LobeSelection()), 0);
}

TEST(ConductorMaterial, TakesItsIndexRelativeToTheOutside) {
  FakeProperties properties;
  properties.colours["eta"] = Rgb(2, 3, 4);
  properties.colours["k"] = Rgb(1, 0.5f, 0);
  properties.texts["ext_eta"] = "Water";
  const float eta = 4 / 1.333f, red_eta = 2 / 1.333f, red_k = 1 / 1.333f;
  EXPECT_NEAR(albedo(make_plugin("conductor", properties)).b, (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1)), 1e-6f);
  EXPECT_NEAR(albedo(make_plugin("conductor", properties)).r,
              ((red_eta - 1) * (red_eta - 1) + red_k * red_k) / ((red_eta + 1) * (red_eta + 1) + red_k * red_k), 1e-6f);
}

TEST(ConductorMaterial, RefusesPresetsThatItDoesNotKnow) {
  FakeProperties unknown;
  unknown.texts["material"] = "Unobtainium";
  EXPECT_THROW(make_plugin("conductor", unknown), BadProperty);
}

TEST(TwoSided, TurnsItsBsdfTowardsTheViewer) {
  FakeProperties properties;
  EXPECT_THROW(make_plugin("twosided", properties), BadProperty);
  properties.nested.push_back(make_plugin("diffuse"));
  const MaterialPtr material = make_plugin("twosided", properties);
  EXPECT_TRUE(material->turns_frame());
  const Shading below = shade(*material, k_down);
  EXPECT_EQ(below.frame.to_local(k_down), k_up);
  EXPECT_EQ(below.bsdf.eval(k_up, k_up, LobeSelection()), Rgb(0.5f * k_inv_pi));
  properties.nested.push_back(make_mirror(Texture(Rgb(0.25f))));
  const MaterialPtr different = make_plugin("twosided", properties);
  EXPECT_EQ(albedo(different, k_up), Rgb(0.5f));
  EXPECT_EQ(albedo(different, k_down), Rgb(0.25f));
  properties.nested.push_back(make_plugin("diffuse"));
  EXPECT_THROW(make_plugin("twosided", properties), BadProperty);
}

TEST(TwoSided, RefusesWhatTransmits) {
  for (const char* name : {"dielectric", "thindielectric", "roughdielectric", "null"}) {
    FakeProperties properties;
    properties.nested = {make_plugin(name)};
    EXPECT_THROW(make_plugin("twosided", properties), BadProperty) << name;
    properties.nested = {make_plugin("diffuse"), make_plugin(name)};
    EXPECT_THROW(make_plugin("twosided", properties), BadProperty) << name;
    std::swap(properties.nested[0], properties.nested[1]);
    EXPECT_THROW(make_plugin("twosided", properties), BadProperty) << name;
  }
}

TEST(RefractiveIndices, HaveNamesInAnyCaseAndNumbers) {
  EXPECT_EQ(dielectric_index("BK7"), 1.5046f);
  EXPECT_EQ(dielectric_index("carbon dioxide"), 1.00045f);
  EXPECT_FALSE(dielectric_index("unobtainium"));
  EXPECT_TRUE(conductor_index("W_palik"));
  EXPECT_EQ(conductor_index("Hg_palik")->eta, conductor_index("Hg")->eta);
  EXPECT_FALSE(conductor_index("cu"));
  for (const std::string& name : conductor_names()) {
    const ConductorIndex index = conductor_index(name).value();
    for (int channel = 0; channel < 3; ++channel) EXPECT_TRUE(index.eta[channel] >= 0 && index.k[channel] >= 0) << name;
  }
}

TEST(DielectricMaterials, TakeTheirIndicesByNameAndNumber) {
  const auto reflected = [](const char* plugin, const FakeProperties& properties) {
    const MaterialPtr material = make_plugin(plugin, properties);
    return shade(*material, k_up).bsdf.sample(k_up, 0, {}, LobeSelection().only_other()).value().pdf_solid_angle;
  };
  const auto at_normal = [](float eta) { return (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1)); };
  EXPECT_NEAR(reflected("dielectric", {}), at_normal(1.5046f / 1.000277f), 1e-6f);
  FakeProperties diamond;
  diamond.texts["int_ior"] = "diamond";
  diamond.reals["ext_ior"] = 1.333f;
  EXPECT_NEAR(reflected("dielectric", diamond), at_normal(2.419f / 1.333f), 1e-6f);
  for (const char* name : {"dielectric", "thindielectric", "roughdielectric", "plastic", "roughplastic"}) {
    FakeProperties bad;
    bad.texts["int_ior"] = "unobtainium";
    EXPECT_THROW(make_plugin(name, bad), BadProperty) << name;
    bad.texts.clear();
    bad.reals["ext_ior"] = -1;
    EXPECT_THROW(make_plugin(name, bad), BadProperty) << name;
  }
  for (const char* name : {"roughdielectric", "plastic", "roughplastic"}) {
    FakeProperties equal;
    equal.reals["int_ior"] = equal.reals["ext_ior"] = 1.3f;
    EXPECT_THROW(make_plugin(name, equal), BadProperty) << name;
  }
}

TEST(RoughMaterials, TakeTheirDistributionAndRoughness) {
  for (const char* name : {"roughconductor", "roughdielectric", "roughplastic"}) {
    FakeProperties properties;
    properties.reals["alpha"] = 0.25f;
    properties.texts["distribution"] = "GGX";
    properties.booleans["sample_visible"] = false;
    EXPECT_NE(make_plugin(name, properties), nullptr) << name;
    for (const char* unsupported : {"phong", "as", "blinn"}) {
      properties.texts["distribution"] = unsupported;
      EXPECT_THROW(make_plugin(name, properties), BadProperty) << name << " " << unsupported;
    }
    properties.texts["distribution"] = "beckmann";
    properties.reals["alpha"] = -0.1f;
    EXPECT_THROW(make_plugin(name, properties), BadProperty) << name;
  }
  FakeProperties properties;
  properties.reals["alpha_u"] = 0.25f;
  EXPECT_THROW(make_plugin("roughconductor", properties), BadProperty);
  properties.reals["alpha_v"] = 0.5f;
  const MaterialPtr brushed = make_plugin("roughconductor", properties);
  const auto lobe = std::get<RoughConductor>(shade(*brushed, k_up).bsdf.entries().front().lobe);
  EXPECT_EQ(lobe.microfacet.alpha_u, 0.25f);
  EXPECT_EQ(lobe.microfacet.alpha_v, 0.5f);
  EXPECT_EQ(lobe.microfacet.type, MicrofacetType::beckmann);
  EXPECT_TRUE(brushed->needs_derivatives());
  EXPECT_FALSE(make_plugin("roughconductor")->needs_derivatives());
  properties.reals["alpha"] = 0.5f;
  EXPECT_THROW(make_plugin("roughconductor", properties), BadProperty);
}

/// u in all channels.
class Ramp final : public TextureMap {
 public:
  Rgb eval(Vec2 uv) const override { return Rgb(uv.x); }
  Vec2 gradient(Vec2) const override { return {1, 0}; }
  Rgb max_value() const override { return Rgb(1); }
  Rgb min_value() const override { return Rgb(0.05f); }
  std::size_t memory_bytes() const override { return 0; }
};

TEST(RoughMaterials, BoundAllThatTheirTexturesSay) {
  const LobeSelection lobes;
  for (const char* name : {"roughconductor", "roughdielectric"}) {
    FakeProperties properties;
    properties.textures["alpha"] = Texture(std::make_shared<Ramp>());
    properties.texts["distribution"] = "ggx";
    const MaterialPtr material = make_plugin(name, properties);
    EXPECT_TRUE(material->has_other_lobes(lobes));
    const float everywhere = material->max_connectable_pi_f(lobes);
    for (const float alpha : {0.05f, 0.1f, 0.2f, 1.0f}) {
      const Bsdf bsdf = shade(*material, k_up, {alpha, 0}).bsdf;
      EXPECT_EQ(bsdf.has(lobes.only_other()), alpha < 0.1f);
      const Vec3 grazing = normalize(Vec3{1, 0, 1e-4f}), opposite{-grazing.x, 0, grazing.z};
      EXPECT_LE(k_pi * bsdf.eval(grazing, opposite, lobes.only_connectable()).r, everywhere);
      EXPECT_LE(bsdf.connectable_value_bound(grazing, lobes).max(), everywhere * 1.001f);
    }
  }
}

TEST(Mask, MixesWithWhatIsBehindByColour) {
  FakeProperties properties;
  EXPECT_THROW(make_plugin("mask", properties), BadProperty);
  properties.nested = {make_plugin("diffuse")};
  properties.colours["opacity"] = Rgb(1, 0.25f, 0);
  const Bsdf bsdf = shade(*make_plugin("mask", properties), k_up).bsdf;
  EXPECT_EQ(bsdf.eval(k_up, k_up, LobeSelection()), Rgb(0.5f, 0.125f, 0) * k_inv_pi);
  EXPECT_EQ(bsdf.straight_transmittance(), Rgb(0, 0.75f, 1));
  EXPECT_EQ(bsdf.pass_probability(k_up), 1 / 1.5f);  // what passes against the nested lobe's 0.5
}

TEST(Mask, CrossesUnlessItIsOpaqueEverywhere) {
  const MaterialPtr diffuse = make_plugin("diffuse"), pane = make_thin_dielectric(1.5f);
  EXPECT_TRUE(make_mask(Texture(Rgb(1, 0.5f, 1)), diffuse)->crosses());
  EXPECT_TRUE(make_mask(Texture(std::make_shared<Ramp>()), diffuse)->crosses());
  EXPECT_FALSE(make_mask(Texture(Rgb(1)), diffuse)->crosses());
  EXPECT_TRUE(make_mask(Texture(Rgb(1)), pane)->crosses());
  EXPECT_FALSE(make_mask(Texture(Rgb(0.5f)), diffuse)->has_other_lobes(LobeSelection())) << "no lobe passes light";
  // What is inside passes its share of what the mask stops.
  const float inside = shade(*pane, k_up).bsdf.straight_transmittance().g;
  EXPECT_NEAR(shade(*make_mask(Texture(Rgb(0.25f)), pane), k_up).bsdf.straight_transmittance().g,
              0.75f + 0.25f * inside, 1e-6f);
}

TEST(Mask, IsAtItsEndsWhatIsInsideAndNothing) {
  const MaterialPtr ramp = make_mask(Texture(std::make_shared<Ramp>()), make_plugin("diffuse"));
  const Bsdf opaque = shade(*ramp, k_up, {1, 0}).bsdf, clear = shade(*ramp, k_up, {0, 0}).bsdf;
  EXPECT_EQ(opaque.entries().size(), 1u);
  EXPECT_EQ(opaque.straight_transmittance(), Rgb());
  EXPECT_EQ(opaque.pass_probability(k_up), 0);
  EXPECT_EQ(clear.entries().size(), 0u);
  EXPECT_EQ(clear.straight_transmittance(), Rgb(1));
  EXPECT_EQ(clear.pass_probability(k_up), 1);
  EXPECT_FALSE(clear.has(LobeSelection().only_connectable()));
}

MaterialPtr blend(std::vector<MaterialPtr> nested, Texture weight) {
  FakeProperties properties;
  properties.nested = std::move(nested);
  properties.textures["weight"] = std::move(weight);
  return make_plugin("blendbsdf", properties);
}

TEST(Blend, MixesByItsWeight) {
  const MaterialPtr white = make_diffuse(Texture(Rgb(1))), black = make_diffuse(Texture(Rgb(0.2f)));
  const MaterialPtr material = blend({black, white}, Texture(std::make_shared<Ramp>()));
  EXPECT_NEAR(shade(*material, k_up, {0.25f, 0}).bsdf.albedo().r, 0.75f * 0.2f + 0.25f, 1e-6f);
  EXPECT_EQ(shade(*material, k_up, {0, 0}).bsdf.entries().size(), 1u);
  EXPECT_EQ(shade(*material, k_up, {1, 0}).bsdf.albedo(), Rgb(1));
}

TEST(Blend, OfTwoSidedAndOneSidedIsHalfAsBrightFromBehind) {
  const MaterialPtr one = make_diffuse(Texture(Rgb(1))), two = make_two_sided(one, one);
  for (const auto& nested : {std::vector{one, two}, std::vector{two, one}}) {
    const MaterialPtr material = blend(nested, Texture(Rgb(0.5f)));
    EXPECT_EQ(shade(*material, k_up).bsdf.energy(k_up, LobeSelection()), 1);
    const Shading behind = shade(*material, k_down);
    EXPECT_EQ(behind.bsdf.energy(behind.frame.to_local(k_down), LobeSelection()), 0.5f);
  }
}

TEST(Blend, RefusesWhatItCannotMix) {
  const Texture half(Rgb(0.5f));
  const MaterialPtr diffuse = make_plugin("diffuse"), two_sided = make_two_sided(diffuse, diffuse);
  EXPECT_THROW(blend({diffuse}, half), BadProperty);
  EXPECT_THROW(blend({diffuse, diffuse, diffuse}, half), BadProperty);
  EXPECT_THROW(blend({two_sided, make_dielectric(1.5f)}, half), BadProperty);
  MaterialPtr many = make_plastic(1.5f, half, false);
  for (int i = 0; i < 2; ++i) many = blend({many, many}, half);
  EXPECT_EQ(many->max_lobes(), 8);
  EXPECT_THROW(blend({many, diffuse}, half), BadProperty);
}

TEST(Null, LetsAllLightPass) {
  const Vec3 known = normalize(Vec3{1, 2, -3});
  const Bsdf bsdf = shade(*make_plugin("null"), known).bsdf;
  EXPECT_EQ(bsdf.straight_transmittance(), Rgb(1));
  EXPECT_EQ(bsdf.pass_probability(known), 1);
  EXPECT_FALSE(bsdf.sample(known, 0.5f, {}, LobeSelection()));
}

}  // namespace
}  // namespace gradslc
