#include "materials/material.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <stdexcept>
#include <string>

namespace gradslc {
namespace {

struct BadProperty : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Properties from tables; a bad one throws BadProperty with the property's name.
class FakeProperties final : public PropertyReader {
 public:
  std::map<std::string, std::string, std::less<>> texts;
  std::map<std::string, Rgb, std::less<>> colours;
  std::vector<Material> nested;

  bool boolean(std::string_view, bool default_value) override { return default_value; }
  float real(std::string_view, float default_value) override { return default_value; }
  std::string text(std::string_view name, std::string_view default_value) override {
    const auto found = texts.find(name);
    return found == texts.end() ? std::string(default_value) : found->second;
  }
  Rgb colour(std::string_view name, Rgb default_value) override {
    const auto found = colours.find(name);
    return found == colours.end() ? default_value : found->second;
  }
  Texture texture(std::string_view name, Rgb default_value) override { return Texture(colour(name, default_value)); }
  std::vector<Material> nested_materials() override { return nested; }
  void fail(std::string_view name, const std::string& message) const override {
    throw BadProperty(std::string(name) + ": " + message);
  }
};

Material make(std::string_view name, FakeProperties properties = {}) {
  for (const BsdfEntry& entry : bsdf_registry())
    if (entry.name == name) return entry.make(properties);
  throw std::logic_error("not in the registry");
}

TEST(BsdfRegistry, NamesAreUnique) {
  std::set<std::string> names;
  for (const BsdfEntry& entry : bsdf_registry()) EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
}

TEST(DiffuseMaterial, HasTheFormatsDefaultAndTakesItsReflectance) {
  EXPECT_EQ(make("diffuse").resolve({}).lambert_albedo(), Rgb(0.5f));
  FakeProperties red;
  red.colours["reflectance"] = Rgb(0.9f, 0.1f, 0);
  const Material material = make("diffuse", red);
  EXPECT_EQ(material.resolve({}).albedo(), Rgb(0.9f, 0.1f, 0));
  EXPECT_FALSE(material.two_sided);
  EXPECT_EQ(material.max_connectable_albedo(LobeSelection()), 0.9f);
  EXPECT_FALSE(material.has_other_lobes(LobeSelection()));
}

TEST(ConductorMaterial, IsCopperByDefaultAndAMirrorByName) {
  const Vec3 up{0, 0, 1};
  const auto reflectance = [&](const Material& material) {
    return material.resolve({}).sample(up, 0, {}, LobeSelection()).value().weight;
  };
  const Rgb copper = reflectance(make("conductor"));
  EXPECT_TRUE(copper.r > 0.9f && copper.g > 0.5f && copper.g < 0.7f && copper.b < copper.g);
  FakeProperties none;
  none.texts["material"] = "none";
  EXPECT_EQ(reflectance(make("conductor", none)), Rgb(1));
  EXPECT_TRUE(make("conductor").has_other_lobes(LobeSelection()));
  EXPECT_EQ(make("conductor").max_connectable_albedo(LobeSelection()), 0);
}

TEST(ConductorMaterial, RefusesPresetsThatItDoesNotKnow) {
  FakeProperties unknown;
  unknown.texts["material"] = "Unobtainium";
  EXPECT_THROW(make("conductor", unknown), BadProperty);
}

TEST(TwoSided, MirrorsItsOneBsdf) {
  FakeProperties properties;
  EXPECT_THROW(make("twosided", properties), BadProperty);
  properties.nested.push_back(make("diffuse"));
  const Material material = make("twosided", properties);
  EXPECT_TRUE(material.two_sided);
  const Vec3 below{0, 0, -1};
  EXPECT_EQ(material.resolve({}).eval(below, below, LobeSelection()), Rgb(0.5f * k_inv_pi));
  properties.nested.push_back(make("diffuse"));
  EXPECT_THROW(make("twosided", properties), BadProperty);
}

}  // namespace
}  // namespace gradslc
