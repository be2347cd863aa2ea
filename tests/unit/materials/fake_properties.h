#pragma once

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "materials/material.h"

namespace gradslc {

struct BadProperty : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Properties from tables; a bad one throws BadProperty with the property's name.
class FakeProperties final : public PropertyReader {
 public:
  std::map<std::string, bool, std::less<>> booleans;
  std::map<std::string, float, std::less<>> reals;
  std::map<std::string, std::string, std::less<>> texts;
  std::map<std::string, Rgb, std::less<>> colours;
  std::map<std::string, Texture, std::less<>> textures;
  std::vector<MaterialPtr> nested;

  bool has(std::string_view name) const override { return given().contains(name); }
  bool is_text(std::string_view name) const override { return texts.contains(name); }
  bool boolean(std::string_view name, bool default_value) override { return take(booleans, name, default_value); }
  float real(std::string_view name, float default_value) override {
    if (is_text(name)) fail(name, "not a number");
    return take(reals, name, default_value);
  }
  std::string text(std::string_view name, std::string_view default_value) override {
    if (reals.contains(name)) fail(name, "not a text");
    return take(texts, name, std::string(default_value));
  }
  Rgb colour(std::string_view name, Rgb default_value) override {
    return take(colours, name, reals.contains(name) ? Rgb(reals.find(name)->second) : default_value);
  }
  Texture texture(std::string_view name, Rgb default_value) override {
    return take(textures, name, Texture(colour(name, default_value)));
  }
  std::vector<Texture> nested_textures() override { return {}; }
  std::vector<MaterialPtr> nested_materials() override { return nested; }
  void ignore(std::string_view name) override { read_.emplace(name); }
  [[noreturn]] void fail(std::string_view name, const std::string& message) const override {
    throw BadProperty(std::string(name) + ": " + message);
  }

  /// Names that nobody has read.
  std::set<std::string> unread() const {
    std::set<std::string> names;
    for (const std::string& name : given())
      if (!read_.contains(name)) names.insert(name);
    return names;
  }

 private:
  template <class Value>
  Value take(const std::map<std::string, Value, std::less<>>& table, std::string_view name, Value default_value) {
    read_.emplace(name);
    const auto found = table.find(name);
    return found == table.end() ? default_value : found->second;
  }
  std::set<std::string, std::less<>> given() const {
    std::set<std::string, std::less<>> names;
    const auto add = [&](const auto& table) {
      for (const auto& [name, value] : table) names.insert(name);
    };
    add(booleans), add(reals), add(texts), add(colours), add(textures);
    return names;
  }

  std::set<std::string, std::less<>> read_;
};

/// The plug-in of that name in the registry, made from `properties`. Throws std::logic_error if a property is left
/// unread.
inline MaterialPtr make_plugin(std::string_view name, FakeProperties properties = {}) {
  for (const BsdfEntry& entry : bsdf_registry())
    if (entry.name == name) {
      MaterialPtr material = entry.make(properties);
      if (!properties.unread().empty()) throw std::logic_error(*properties.unread().begin() + " is not read");
      return material;
    }
  throw std::logic_error("not in the registry");
}

/// A material seen from the world direction `known` at a point whose shading frame is the world's.
inline Shading shade(const Material& material, Vec3 known, Vec2 uv = {}) {
  Shading shading;
  material.shade({uv, {1, 0, 0}, {0, 1, 0}}, known, shading);
  return shading;
}

}  // namespace gradslc
