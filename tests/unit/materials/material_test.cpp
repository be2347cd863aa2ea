// Plug-ins as scene files make them: names, defaults, errors.

#include "materials/material.h"

#include <gtest/gtest.h>

#include <set>

#include "materials/plugins.h"
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
  const Rgb weight = shade(*make_plugin("conductor", properties), k_up).bsdf.energy(k_up, LobeSelection()) * Rgb(1);
  const float eta = 4 / 1.333f, red_eta = 2 / 1.333f, red_k = 1 / 1.333f;
  EXPECT_NEAR(albedo(make_plugin("conductor", properties)).b, (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1)), 1e-6f);
  EXPECT_NEAR(albedo(make_plugin("conductor", properties)).r,
              ((red_eta - 1) * (red_eta - 1) + red_k * red_k) / ((red_eta + 1) * (red_eta + 1) + red_k * red_k), 1e-6f);
  EXPECT_GT(weight.r, 0);
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
  }
}

}  // namespace
}  // namespace gradslc
