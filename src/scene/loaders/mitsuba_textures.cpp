#include "scene/loaders/mitsuba_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "materials/bitmap.h"
#include "materials/checkerboard.h"
#include "materials/scaled_texture.h"
#include "scene/loaders/images.h"

namespace gradslc {
namespace {

constexpr std::size_t k_max_depth = 64;

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

/// Mitsuba 0.6: factors and offsets; Mitsuba 3: the upper left 3x3 part of a matrix, applied to (u, v, 1).
UvTransform read_uv_transform(MitsubaTextures& textures, MitsubaProperties& properties) {
  if (properties.has("to_uv")) {
    const Transform matrix = properties.transform("to_uv");
    const Vec3 u = matrix.column(0), v = matrix.column(1), offset = matrix.column(2);
    if (matrix.column(3) != Vec3())
      textures.document().note(properties.element(),
                               "the translation in to_uv has no effect, as in Mitsuba 3: the "
                               "third column of a 3x3 <matrix> moves uvs");
    return {{u.x, v.x}, {u.y, v.y}, {offset.x, offset.y}};
  }
  const float scale = properties.real("uvscale", 1);
  return {{properties.real("uscale", scale), 0},
          {0, properties.real("vscale", scale)},
          {properties.real("uoffset", 0), properties.real("voffset", 0)}};
}

Wrap read_wrap(MitsubaProperties& properties, std::string_view name, std::string_view default_value) {
  const std::string mode = properties.text(name, default_value);
  if (mode == "repeat") return Wrap::repeat;
  if (mode == "mirror") return Wrap::mirror;
  if (mode == "clamp") return Wrap::clamp;
  if (mode == "zero" || mode == "black") return Wrap::zero;
  if (mode == "one" || mode == "white") return Wrap::one;
  properties.fail(
      name, fmt::format("\"{}\" must be repeat, mirror, clamp, zero (black) or one (white), not \"{}\"", name, mode));
}

bool read_nearest(MitsubaTextures& textures, MitsubaProperties& properties) {
  const std::string filter = properties.text("filter_type", "bilinear");
  if (filter == "trilinear" || filter == "ewa")
    textures.note_filter(properties, filter);
  else if (filter != "bilinear" && filter != "nearest")
    properties.fail("filter_type",
                    fmt::format("\"filter_type\" must be bilinear, nearest, trilinear or ewa, not \"{}\"", filter));
  return filter == "nearest";
}

/// -1 where none is chosen.
int read_channel(MitsubaProperties& properties, int channels) {
  const std::string name = properties.text("channel", "");
  if (name.empty()) return -1;
  constexpr std::string_view k_names[] = {"", "y", "ya", "rgb", "rgba"};
  const std::string_view names = k_names[channels];
  if (name.size() != 1 || names.find(name) == std::string_view::npos)
    properties.fail("channel", fmt::format("the image has no channel \"{}\"; it has: {}", name,
                                           fmt::join(names.begin(), names.end(), ", ")));
  return static_cast<int>(names.find(name));
}

/// Integers are sRGB-encoded unless the file says otherwise, but for alpha; floats are linear.
Encoding read_encoding(MitsubaProperties& properties, const Texels& texels, int channel) {
  const bool raw = properties.boolean("raw", false);
  const float gamma = properties.real("gamma", 0);
  if (gamma < 0 && gamma != Encoding::k_srgb)
    properties.fail("gamma", "\"gamma\" must be positive, -1 (sRGB) or 0 (automatic)");
  if (raw) return {1};
  if (gamma != 0) return {gamma};
  const bool alpha = texels.channels % 2 == 0 && channel == texels.channels - 1;
  return {alpha || std::holds_alternative<std::vector<float>>(texels.values) ? 1 : Encoding::k_srgb};
}

Texture make_bitmap_texture(MitsubaTextures& textures, MitsubaProperties& properties) {
  const std::shared_ptr<const Texels> texels = textures.image(properties);
  BitmapOptions options;
  options.to_uv = read_uv_transform(textures, properties);
  const std::string wrap = properties.text("wrap_mode", "repeat");
  read_wrap(properties, "wrap_mode", wrap);
  options.wrap_u = read_wrap(properties, "wrap_mode_u", wrap);
  options.wrap_v = read_wrap(properties, "wrap_mode_v", wrap);
  options.nearest = read_nearest(textures, properties);
  options.channel = read_channel(properties, texels->channels);
  options.encoding = read_encoding(properties, *texels, options.channel);
  for (const char* name : {"max_anisotropy", "cache", "max_resolution", "accel", "format"}) properties.ignore(name);
  const Texture bitmap(make_bitmap(texels, options));
  if (!is_finite(bitmap.max_value())) properties.fail("gamma", "\"gamma\" makes values that are too large");
  return bitmap;
}

Texture make_checkerboard_texture(MitsubaTextures& textures, MitsubaProperties& properties) {
  Texture first = textures.property(properties, "color0", Rgb(0.4f));
  Texture second = textures.property(properties, "color1", Rgb(0.2f));
  return Texture(make_checkerboard(std::move(first), std::move(second), read_uv_transform(textures, properties)));
}

Texture make_scale_texture(MitsubaTextures& textures, MitsubaProperties& properties) {
  const Rgb factor = properties.colour("scale", Rgb(1.0f));
  const std::vector<Texture> nested = textures.nested(properties);
  if (nested.size() != 1) properties.fail("", "a scale texture needs one texture inside");
  return scale_texture(nested.front(), factor);
}

constexpr TextureEntry k_textures[] = {
    {"bitmap", "an image file over [0,1]^2, v downwards", make_bitmap_texture},
    {"checkerboard", "squares of two colours or textures, two by two in each unit square", make_checkerboard_texture},
    {"scale", "the texture inside, times a colour", make_scale_texture},
};

}  // namespace

std::span<const TextureEntry> texture_registry() { return k_textures; }

MitsubaTextures::MitsubaTextures(MitsubaDocument& document) : document_(document) {
  for (const XmlElement& object : document_.objects()) find_images(object);
  read_images();
}

void MitsubaTextures::find_images(const XmlElement& element) {
  const bool bitmap = std::string_view(element.node.name()) == "texture" &&
                      std::string_view(element.node.attribute("type").value()) == "bitmap";
  for (const pugi::xml_node child : element.node.children()) {
    if (child.type() != pugi::node_element) continue;
    const XmlElement property{element.document, child};
    if (bitmap && std::string_view(child.attribute("name").value()) == "filename") {
      const std::filesystem::path file = document_.resolve_path(property, document_.attribute(property, "value"));
      if (is_file(file)) images_.try_emplace(file);
    }
    find_images(property);
  }
}

void MitsubaTextures::read_images() {
  std::vector<std::pair<const std::filesystem::path, Image>*> images;
  images.reserve(images_.size());
  for (auto& image : images_) images.push_back(&image);
  parallel_for(images.size(), 1, [&](std::size_t begin, std::size_t) {
    auto& [file, image] = *images[begin];
    try {
      image = std::make_shared<const Texels>(read_image(file));
    } catch (...) {
      image = std::current_exception();
    }
  });
}

std::shared_ptr<const Texels> MitsubaTextures::image(MitsubaProperties& properties) {
  const std::string name = properties.text("filename", "");
  if (name.empty()) properties.fail("filename", "a bitmap needs a filename");
  const std::filesystem::path file = document_.resolve_path(properties.element(), name);
  if (!is_file(file)) properties.fail("filename", fmt::format("file \"{}\" does not exist", file.string()));
  document_.add_file(file);
  const auto found = images_.find(file);
  if (found == images_.end()) return std::make_shared<const Texels>(read_image(file));
  if (const auto* failure = std::get_if<std::exception_ptr>(&found->second)) std::rethrow_exception(*failure);
  return std::get<std::shared_ptr<const Texels>>(found->second);
}

Texture MitsubaTextures::build(const XmlElement& texture) {
  if (const auto found = built_.find(texture.node); found != built_.end()) return found->second;
  if (!in_progress_.insert(texture.node).second) document_.fail(texture, "this texture contains itself");
  if (in_progress_.size() > k_max_depth)
    document_.fail(texture, fmt::format("textures are nested more than {} deep", k_max_depth));
  Texture built = make(texture);
  in_progress_.erase(texture.node);
  return built_.emplace(texture.node, std::move(built)).first->second;
}

Texture MitsubaTextures::make(const XmlElement& texture) {
  MitsubaProperties properties(document_, texture);
  std::vector<std::string> names;
  for (const TextureEntry& candidate : texture_registry()) {
    if (properties.plugin() == candidate.name) {
      Texture made = candidate.make(*this, properties);
      properties.finish();
      return made;
    }
    names.emplace_back(candidate.name);
  }
  document_.unknown(
      texture, fmt::format("unknown texture \"{}\"{}", properties.plugin(), suggestion(properties.plugin(), names)),
      "type", "grey 0.5 takes its place");
  return Texture(Rgb(0.5f));
}

Texture MitsubaTextures::property(MitsubaProperties& properties, std::string_view name, Rgb default_value) {
  if (const auto texture = properties.texture_element(name)) return build(*texture);
  return Texture(properties.colour(name, default_value));
}

std::vector<Texture> MitsubaTextures::nested(MitsubaProperties& properties) {
  std::vector<Texture> nested;
  for (const XmlElement& texture : properties.unread_objects("texture")) nested.push_back(build(texture));
  return nested;
}

void MitsubaTextures::note_filter(const MitsubaProperties& properties, std::string_view filter) {
  if (filter_noted_) return;
  document_.note(properties.element(),
                 fmt::format("filter_type \"{}\": all bitmaps are interpolated bilinearly, without a filter", filter));
  filter_noted_ = true;
}

}  // namespace gradslc
