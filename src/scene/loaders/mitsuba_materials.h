#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "materials/material.h"
#include "scene/loaders/mitsuba_document.h"
#include "scene/loaders/mitsuba_textures.h"

namespace gradslc {

/// The materials of a scene: each <bsdf> is built once, however often it is referred to.
class MitsubaMaterials {
 public:
  /// Both must outlive this.
  MitsubaMaterials(MitsubaDocument& document, MitsubaTextures& textures) : document_(document), textures_(textures) {}

  struct Built {
    MaterialPtr material;
    MaterialName name;
  };
  /// Throws Error (input) where a bsdf is unknown or wrong, or contains itself.
  const Built& build(const XmlElement& bsdf);
  /// Index into the scene's materials.
  std::uint32_t index(const XmlElement& bsdf);
  /// Of what a shape without a bsdf is made: diffuse, reflectance 0.5.
  std::uint32_t default_index();
  /// All materials that have an index, and their names.
  std::vector<MaterialPtr> take_materials() { return std::move(materials_); }
  std::vector<MaterialName> take_names() { return std::move(names_); }

 private:
  Built make(const XmlElement& bsdf);
  std::uint32_t add(Built built);

  MitsubaDocument& document_;
  MitsubaTextures& textures_;
  std::map<pugi::xml_node, Built> built_;
  std::set<pugi::xml_node> in_progress_;
  std::map<pugi::xml_node, std::uint32_t> indices_;
  std::vector<MaterialPtr> materials_;
  std::vector<MaterialName> names_;
  std::optional<std::uint32_t> default_index_;
};

}  // namespace gradslc
