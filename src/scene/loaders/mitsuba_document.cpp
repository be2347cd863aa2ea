#include "scene/loaders/mitsuba_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace gradslc {
namespace {

constexpr int k_max_include_depth = 16;
constexpr std::size_t k_max_documents = 10000;  // a file that includes twice what includes twice ... ends somewhere
constexpr int k_max_element_depth = 64;
/// Characters of a value after substitution: defaults made of defaults grow exponentially.
constexpr std::size_t k_max_value = 65536;

bool is_identifier_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

std::vector<std::string> keys(const auto& map) {
  std::vector<std::string> names;
  names.reserve(map.size());
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

}  // namespace

std::string snake_case(std::string_view camel_case) {
  const auto is_upper = [&](std::size_t i) { return std::isupper(static_cast<unsigned char>(camel_case[i])) != 0; };
  std::string name;
  for (std::size_t i = 0; i < camel_case.size(); ++i) {
    if (is_upper(i) && i > 0 && !is_upper(i - 1)) name += '_';
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(camel_case[i])));
  }
  return name;
}

MitsubaDocument::MitsubaDocument(const std::filesystem::path& file, const LoadOptions& options)
    : options_(options), definitions_(options.definitions.begin(), options.definitions.end()) {
  add_file(file);
  read(std::make_unique<XmlDocument>(file), 0);
  check_definitions();
}

MitsubaDocument::MitsubaDocument(const std::filesystem::path& file, std::string text, const LoadOptions& options)
    : options_(options), definitions_(options.definitions.begin(), options.definitions.end()) {
  read(std::make_unique<XmlDocument>(file.string(), std::move(text)), 0);
  check_definitions();
}

void MitsubaDocument::read(std::unique_ptr<XmlDocument> owned, int depth) {
  const XmlDocument* document = documents_.emplace_back(std::move(owned)).get();
  const XmlElement root{document, document->root()};
  if (std::string_view(root.node.name()) != "scene") fail(root, "the outermost element must be <scene>");
  const std::string version = required_attribute(root, "version");
  int major = -1;
  std::from_chars(version.data(), version.data() + version.size(), major);
  if (major != 0 && major != 2 && major != 3)
    fail(root, fmt::format("version \"{}\" is not supported, only 0.x, 2.x and 3.x are", version), "version");
  if (major == 0) legacy_.insert(document);

  for (const pugi::xml_node node : root.node.children()) {
    const XmlElement element{document, node};
    const std::string_view tag = node.name();
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata)
      fail(root, fmt::format("text \"{:.20}\" between elements", node.value()));
    if (node.type() != pugi::node_element) continue;
    if (tag == "include") {
      read_include(element, depth);
    } else if (tag == "default") {
      read_default(element);
    } else if (tag == "alias") {
      read_alias(element);
    } else {
      register_ids(element, 0);
      objects_.push_back(element);
    }
  }
}

void MitsubaDocument::read_include(const XmlElement& element, int depth) {
  const std::filesystem::path path = resolve_path(element, required_attribute(element, "filename"));
  if (depth >= k_max_include_depth)
    fail(element,
         fmt::format("includes are nested more than {} deep; does a file include itself?", k_max_include_depth),
         "filename");
  if (documents_.size() >= k_max_documents) fail(element, "too many files are included");
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    fail(element, fmt::format("included file \"{}\" does not exist", path.string()), "filename");
  add_file(path);
  read(std::make_unique<XmlDocument>(path), depth + 1);
}

/// A value from the options, or from an earlier default of the same name, comes first.
void MitsubaDocument::read_default(const XmlElement& element) {
  const std::string name = required_attribute(element, "name");
  if (!std::all_of(name.begin(), name.end(), is_identifier_character))
    fail(element, fmt::format("parameter name \"{}\" may hold letters, digits and _ only", name), "name");
  if (!element.node.attribute("value")) fail(element, "attribute \"value\" is missing");
  if (!definitions_.contains(name)) definitions_[name] = attribute(element, "value");
  used_definitions_.insert(name);
}

void MitsubaDocument::read_alias(const XmlElement& element) {
  const std::string id = required_attribute(element, "id");
  const XmlElement target = find(id);
  if (!target.node) fail(element, fmt::format("alias of an unknown id \"{}\"{}", id, id_hint(id)), "id");
  add_id(target, required_attribute(element, "as"), {});
}

void MitsubaDocument::register_ids(const XmlElement& element, int depth) {
  if (depth > k_max_element_depth)
    fail(element, fmt::format("elements are nested more than {} deep", k_max_element_depth));
  if (element.node.attribute("id") && std::string_view(element.node.name()) != "ref")
    add_id(element, required_attribute(element, "id"), "id");
  for (const pugi::xml_node child : element.node.children()) {
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
      fail(element, fmt::format("text \"{:.20}\" between elements", child.value()));
    if (child.type() == pugi::node_element) register_ids({element.document, child}, depth + 1);
  }
}

void MitsubaDocument::add_id(const XmlElement& element, const std::string& id, std::string_view attribute) {
  const auto [existing, added] = ids_.emplace(id, element);
  if (added) return;
  const XmlElement& first = existing->second;
  fail(element, fmt::format("id \"{}\" is taken already, at {}:{}", id, first.document->file(), line(first)),
       attribute);
}

void MitsubaDocument::check_definitions() const {
  for (const auto& [name, value] : options_.definitions)
    if (!used_definitions_.contains(name))
      fail(root(),
           fmt::format(
               "the scene has no parameter \"{}\" to define{}", name,
               used_definitions_.empty()
                   ? ""
                   : suggestion(name, {std::vector<std::string>(used_definitions_.begin(), used_definitions_.end())})));
}

XmlElement MitsubaDocument::find(std::string_view id) const {
  const auto found = ids_.find(id);
  return found == ids_.end() ? XmlElement() : found->second;
}

std::string MitsubaDocument::id_hint(std::string_view id) const {
  return ids_.empty() ? "; there are no ids" : suggestion(id, keys(ids_));
}

std::string MitsubaDocument::attribute(const XmlElement& element, const char* name) const {
  return substitute(element, name, element.node.attribute(name).value());
}

std::string MitsubaDocument::required_attribute(const XmlElement& element, const char* name) const {
  if (!element.node.attribute(name)) fail(element, fmt::format("attribute \"{}\" is missing", name));
  std::string value = attribute(element, name);
  if (value.empty()) fail(element, fmt::format("attribute \"{}\" is empty", name), name);
  return value;
}

/// Of several parameters that fit ($a and $ab) the longest is meant, as in Mitsuba. Values are not substituted again.
std::string MitsubaDocument::substitute(const XmlElement& element, const char* name, std::string_view value) const {
  std::string result;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] != '$') {
      result += value[i];
      continue;
    }
    std::size_t end = i + 1;
    while (end < value.size() && is_identifier_character(value[end])) ++end;
    const std::string_view written = value.substr(i + 1, end - i - 1);
    std::string_view parameter = written;
    while (!parameter.empty() && !definitions_.contains(parameter)) parameter.remove_suffix(1);
    if (parameter.empty()) {
      std::string hint =
          definitions_.empty() ? "; no <default> stands before it" : suggestion(written, keys(definitions_));
      fail(element, fmt::format("parameter \"${}\" has no value{}", written, hint), name);
    }
    used_definitions_.insert(std::string(parameter));
    result += definitions_.find(parameter)->second;
    if (result.size() > k_max_value)
      fail(element, fmt::format("the value is longer than {} characters", k_max_value), name);
    i += parameter.size();
  }
  return result;
}

std::string MitsubaDocument::modern_name(const XmlElement& element, std::string_view name) const {
  return is_legacy(element) ? snake_case(name) : std::string(name);
}

std::filesystem::path MitsubaDocument::resolve_path(const XmlElement& element, const std::string& path) const {
  return std::filesystem::path(element.document->file()).parent_path() / path;
}

void MitsubaDocument::add_file(const std::filesystem::path& file) {
  if (known_files_.insert(file).second) files_.push_back(file);
}

void MitsubaDocument::fail(const XmlElement& element, std::string message, std::string_view attribute) const {
  throw_input_error(element.document->position(element.node, attribute), std::move(message));
}

void MitsubaDocument::unknown(const XmlElement& element, std::string message, std::string_view attribute,
                              std::string_view instead) {
  if (!options_.permissive) fail(element, std::move(message), attribute);
  note(element, fmt::format("{}; {}", message, instead));
}

void MitsubaDocument::note(const XmlElement& element, std::string_view message) {
  std::string text = fmt::format("{}:{}: {}", element.document->file(), line(element), message);
  if (known_notes_.insert(text).second) notes_.push_back(std::move(text));
}

}  // namespace gradslc
