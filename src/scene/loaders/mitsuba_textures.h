#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "materials/texels.h"
#include "materials/texture.h"
#include "scene/loaders/mitsuba_properties.h"

namespace gradslc {

/// The textures of a scene: each <texture> is built once, however often it is referred to, and each image file is read
/// once.
class MitsubaTextures {
 public:
  /// Reads the images of all bitmaps in the document, in parallel. What is wrong with them is reported where they are
  /// used.
  explicit MitsubaTextures(MitsubaDocument& document);

  /// Throws Error (input) where a texture is unknown or wrong, or contains itself.
  Texture build(const XmlElement& texture);
  /// A property that is a texture or a colour.
  Texture property(MitsubaProperties& properties, std::string_view name, Rgb default_value);
  /// Textures inside that no property has read, in the order of the file.
  std::vector<Texture> nested(MitsubaProperties& properties);
  /// The image that the property "filename" names.
  std::shared_ptr<const Texels> image(MitsubaProperties& properties);
  MitsubaDocument& document() { return document_; }
  /// Notes the first filter that bilinear interpolation takes the place of.
  void note_filter(const MitsubaProperties& properties, std::string_view filter);

 private:
  using Image = std::variant<std::shared_ptr<const Texels>, std::exception_ptr>;
  Texture make(const XmlElement& texture);
  void find_images(const XmlElement& element);
  void read_images();

  MitsubaDocument& document_;
  std::map<std::filesystem::path, Image> images_;
  std::map<pugi::xml_node, Texture> built_;
  std::set<pugi::xml_node> in_progress_;
  bool filter_noted_ = false;
};

struct TextureEntry {
  const char* name;  ///< as in scene files
  const char* meaning;
  Texture (*make)(MitsubaTextures& textures, MitsubaProperties& properties);
};
/// The only list of texture plug-ins.
std::span<const TextureEntry> texture_registry();

}  // namespace gradslc
