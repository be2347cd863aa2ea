#include "scene/loaders/mitsuba_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "materials/plugins.h"
#include "scene/loaders/mitsuba_properties.h"

namespace gradslc {
namespace {

constexpr std::size_t k_max_depth = 64;

/// What bsdf plug-ins see of their element.
class MaterialPropertyReader final : public PropertyReader {
 public:
  MaterialPropertyReader(MitsubaProperties& properties, MitsubaMaterials& materials, MitsubaTextures& textures)
      : properties_(properties), materials_(materials), textures_(textures) {}

  bool has(std::string_view name) const override { return properties_.has(name); }
  bool is_text(std::string_view name) const override { return properties_.is_text(name); }
  bool boolean(std::string_view name, bool default_value) override { return properties_.boolean(name, default_value); }
  float real(std::string_view name, float default_value) override { return properties_.real(name, default_value); }
  std::string text(std::string_view name, std::string_view default_value) override {
    return properties_.text(name, default_value);
  }
  Rgb colour(std::string_view name, Rgb default_value) override { return properties_.colour(name, default_value); }
  Texture texture(std::string_view name, Rgb default_value) override {
    return textures_.property(properties_, name, default_value);
  }
  std::vector<Texture> nested_textures() override { return textures_.nested(properties_); }
  void ignore(std::string_view name) override { properties_.ignore(name); }
  std::vector<MaterialPtr> nested_materials() override {
    std::vector<MaterialPtr> nested;
    for (const XmlElement& bsdf : properties_.objects("bsdf")) {
      const MitsubaMaterials::Built& built = materials_.build(bsdf);
      nested.push_back(built.material);
      nested_kinds_ += " " + built.name.kind;
    }
    return nested;
  }
  [[noreturn]] void fail(std::string_view name, const std::string& message) const override {
    properties_.fail(name, message);
  }
  const std::string& nested_kinds() const { return nested_kinds_; }

 private:
  MitsubaProperties& properties_;
  MitsubaMaterials& materials_;
  MitsubaTextures& textures_;
  std::string nested_kinds_;  // each after a blank
};

MaterialPtr grey_diffuse() { return make_diffuse(Texture(Rgb(0.5f))); }

}  // namespace

const MitsubaMaterials::Built& MitsubaMaterials::build(const XmlElement& bsdf) {
  if (const auto found = built_.find(bsdf.node); found != built_.end()) return found->second;
  if (!in_progress_.insert(bsdf.node).second) document_.fail(bsdf, "this bsdf contains itself");
  if (in_progress_.size() > k_max_depth)
    document_.fail(bsdf, fmt::format("bsdfs are nested more than {} deep", k_max_depth));
  Built built = make(bsdf);
  in_progress_.erase(bsdf.node);
  return built_.emplace(bsdf.node, std::move(built)).first->second;
}

MitsubaMaterials::Built MitsubaMaterials::make(const XmlElement& bsdf) {
  MitsubaProperties properties(document_, bsdf);
  const auto registry = bsdf_registry();
  const auto entry = std::find_if(registry.begin(), registry.end(),
                                  [&](const BsdfEntry& candidate) { return properties.plugin() == candidate.name; });
  if (entry == registry.end()) {
    std::vector<std::string> names;
    for (const BsdfEntry& candidate : registry) names.emplace_back(candidate.name);
    document_.unknown(bsdf,
                      fmt::format("unknown bsdf \"{}\"{}", properties.plugin(), suggestion(properties.plugin(), names)),
                      "type", "diffuse 0.5 takes its place");
    return {grey_diffuse(), {properties.id(), "unknown"}};
  }
  MaterialPropertyReader reader(properties, *this, textures_);
  MaterialPtr material = entry->make(reader);
  properties.finish();
  return {std::move(material), {properties.id(), properties.plugin() + reader.nested_kinds()}};
}

std::uint32_t MitsubaMaterials::index(const XmlElement& bsdf) {
  if (const auto found = indices_.find(bsdf.node); found != indices_.end()) return found->second;
  return indices_[bsdf.node] = add(build(bsdf));
}

std::uint32_t MitsubaMaterials::default_index() {
  if (!default_index_) default_index_ = add({grey_diffuse(), {"default", "diffuse"}});
  return *default_index_;
}

std::uint32_t MitsubaMaterials::add(Built built) {
  materials_.push_back(std::move(built.material));
  names_.push_back(std::move(built.name));
  return static_cast<std::uint32_t>(materials_.size() - 1);
}

}  // namespace gradslc
