#include "scene/loaders/mitsuba_properties.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "core/error.h"
#include "scene/loaders/mitsuba_values.h"

namespace gradslc {
namespace {

constexpr std::string_view k_property_tags[] = {"boolean", "integer",  "float", "string", "rgb",
                                                "srgb",    "spectrum", "point", "vector", "transform"};
constexpr std::string_view k_object_tags[] = {"bsdf",    "shape",   "emitter", "texture",    "sensor", "film",
                                              "sampler", "rfilter", "medium",  "integrator", "phase",  "volume"};

template <class Range>
bool contains(const Range& range, std::string_view name) {
  return std::find(std::begin(range), std::end(range), name) != std::end(range);
}

}  // namespace

MitsubaProperties::MitsubaProperties(MitsubaDocument& document, XmlElement element)
    : document_(document), element_(element), plugin_(document.required_attribute(element, "type")) {
  for (const pugi::xml_node child : element.node.children())
    if (child.type() == pugi::node_element) add({element.document, child});
}

void MitsubaProperties::add(const XmlElement& child) {
  Entry entry{.name = document_.modern_name(child, document_.attribute(child, "name")),
              .type = child.node.name(),
              .element = child,
              .target = child};
  if (entry.type == "ref") {
    const std::string id = document_.required_attribute(child, "id");
    entry.target = document_.find(id);
    if (!entry.target.node)
      document_.fail(child, fmt::format("reference to an unknown id \"{}\"{}", id, document_.id_hint(id)), "id");
    entry.type = entry.target.node.name();
  } else if (!contains(k_property_tags, entry.type) && !contains(k_object_tags, entry.type)) {
    document_.unknown(child,
                      fmt::format("unknown element <{}> in {} \"{}\"", entry.type, element_.node.name(), plugin_));
    return;
  }
  if (contains(k_property_tags, entry.type) && entry.name.empty())
    document_.fail(child, fmt::format("a <{}> needs a name", entry.type));
  if (!entry.name.empty() && !given_.insert(entry.name).second)
    document_.fail(child, fmt::format("property \"{}\" is given twice", entry.name), "name");
  entries_.push_back(std::move(entry));
}

std::string MitsubaProperties::id() const { return document_.attribute(element_, "id"); }

bool MitsubaProperties::has(std::string_view name) const { return given_.contains(name); }

bool MitsubaProperties::is_text(std::string_view name) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& entry) { return entry.name == name && entry.type == "string"; });
}

MitsubaProperties::Entry* MitsubaProperties::take(std::string_view name) {
  known_.emplace(name);
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.name == name; });
  if (found == entries_.end()) return nullptr;
  found->read = true;
  return &*found;
}

MitsubaProperties::Entry* MitsubaProperties::take(std::string_view name, std::initializer_list<std::string_view> types,
                                                  std::string_view expected) {
  Entry* entry = take(name);
  if (entry && !contains(types, entry->type))
    fail(name, fmt::format("\"{}\" is given as <{}>, needs {}", name, entry->type, expected));
  return entry;
}

std::string MitsubaProperties::value(const Entry& entry) const {
  return document_.required_attribute(entry.element, "value");
}

bool MitsubaProperties::boolean(std::string_view name, bool default_value) {
  const Entry* entry = take(name, {"boolean"}, "a <boolean>");
  if (!entry) return default_value;
  const std::string text = value(*entry);
  if (text != "true" && text != "false")
    fail(name, fmt::format("\"{}\" must be true or false, not \"{}\"", name, text));
  return text == "true";
}

int MitsubaProperties::integer(std::string_view name, int default_value) {
  const Entry* entry = take(name, {"integer"}, "an <integer>");
  if (!entry) return default_value;
  const std::string text = value(*entry);
  const std::optional<int> number = parse_integer(text);
  if (!number) fail(name, fmt::format("\"{}\" must be an integer, not \"{}\"", name, text));
  return *number;
}

float MitsubaProperties::real(std::string_view name, float default_value) {
  const Entry* entry = take(name, {"float", "integer"}, "a <float>");
  if (!entry) return default_value;
  const std::string text = value(*entry);
  const std::optional<double> number = parse_number(text);
  if (!number) fail(name, fmt::format("\"{}\" must be a number, not \"{}\"", name, text));
  return static_cast<float>(*number);
}

std::string MitsubaProperties::text(std::string_view name, std::string_view default_value) {
  const Entry* entry = take(name, {"string"}, "a <string>");
  return entry ? document_.attribute(entry->element, "value") : std::string(default_value);
}

Rgb MitsubaProperties::colour(std::string_view name, Rgb default_value) {
  const Entry* entry = take(name, {"rgb", "srgb", "spectrum", "float", "texture"}, "an <rgb>, <spectrum> or <float>");
  if (!entry) return default_value;
  if (entry->type == "texture") {
    document_.unknown(entry->element, fmt::format("\"{}\" cannot be a texture; give an <rgb>", name), {},
                      "its default takes its place");
    return default_value;
  }
  const std::string text = value(*entry);
  if (text.find(':') != std::string::npos)
    fail(name, fmt::format("\"{}\": spectra by wavelength are not supported; give an <rgb>", name));
  const bool coloured = entry->type == "rgb" || entry->type == "srgb";
  if (const auto hex = parse_hex_colour(text); hex && coloured) return *hex;
  const auto numbers = parse_numbers(text);
  const bool three_allowed = coloured || (entry->type == "spectrum" && document_.is_legacy(entry->element));
  if (!numbers || !(numbers->size() == 1 || (numbers->size() == 3 && three_allowed)))
    fail(name, fmt::format("\"{}\" must be {}, not \"{}\"", name,
                           three_allowed ? "one or three numbers (or #rrggbb)" : "one number", text));
  const auto channel = [&](std::size_t i) {
    const auto linear = static_cast<float>((*numbers)[numbers->size() == 1 ? 0 : i]);
    return entry->type == "srgb" ? srgb_to_linear(linear) : linear;
  };
  return {channel(0), channel(1), channel(2)};
}

Vec3 MitsubaProperties::vector(std::string_view name, Vec3 default_value) {
  const Entry* entry = take(name, {"vector", "point"}, "a <vector> or <point>");
  if (!entry) return default_value;
  if (entry->element.node.attribute("value")) {
    const std::string text = value(*entry);
    const auto numbers = parse_numbers(text);
    if (!numbers || numbers->size() != 3)
      fail(name, fmt::format("\"{}\" must be three numbers, not \"{}\"", name, text));
    return {static_cast<float>((*numbers)[0]), static_cast<float>((*numbers)[1]), static_cast<float>((*numbers)[2])};
  }
  const auto component = [&](const char* axis) {
    const std::string text = document_.required_attribute(entry->element, axis);
    const std::optional<double> number = parse_number(text);
    if (!number) document_.fail(entry->element, fmt::format("{} must be a number, not \"{}\"", axis, text), axis);
    return static_cast<float>(*number);
  };
  return {component("x"), component("y"), component("z")};
}

Point3 MitsubaProperties::point(std::string_view name, Point3 default_value) {
  return Point3() + vector(name, from_origin(default_value));
}

Transform MitsubaProperties::transform(std::string_view name) {
  const Entry* entry = take(name, {"transform"}, "a <transform>");
  return entry ? read_transform(document_, entry->element) : Transform();
}

std::vector<XmlElement> MitsubaProperties::objects(std::string_view kind) {
  known_.emplace(kind);
  std::vector<XmlElement> found;
  for (Entry& entry : entries_)
    if (entry.type == kind) entry.read = true, found.push_back(entry.target);
  return found;
}

std::optional<XmlElement> MitsubaProperties::texture_element(std::string_view name) {
  known_.emplace(name);
  for (Entry& entry : entries_) {
    if (entry.name != name || entry.type != "texture") continue;
    entry.read = true;
    return entry.target;
  }
  return std::nullopt;
}

std::vector<XmlElement> MitsubaProperties::unread_objects(std::string_view kind) {
  known_.emplace(kind);
  std::vector<XmlElement> found;
  for (Entry& entry : entries_) {
    if (entry.type != kind || entry.read) continue;
    entry.read = true;
    found.push_back(entry.target);
  }
  return found;
}

void MitsubaProperties::ignore(std::string_view name) {
  if (const Entry* entry = take(name))
    document_.note(entry->element,
                   fmt::format("{} \"{}\": \"{}\" has no effect here", element_.node.name(), plugin_, name));
}

void MitsubaProperties::finish() {
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const Entry& entry : entries_) {
    if (entry.read) continue;
    const std::string owner = fmt::format("{} \"{}\"", element_.node.name(), plugin_);
    if (entry.name.empty() || contains(k_object_tags, entry.type))
      document_.unknown(entry.element, fmt::format("{} has no use for a <{}>", owner, entry.type));
    else
      document_.unknown(entry.element,
                        fmt::format("{} has no property \"{}\"{}", owner, entry.name,
                                    known.empty() ? "; it has none" : suggestion(entry.name, known)),
                        "name");
  }
}

void MitsubaProperties::fail(std::string_view name, const std::string& message) const {
  for (const Entry& entry : entries_)
    if (!name.empty() && entry.name == name) document_.fail(entry.element, message, "value");
  document_.fail(element_, message);
}

}  // namespace gradslc
