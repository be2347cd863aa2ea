#include "scene/loaders/xml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/file.h"

namespace gradslc {
namespace {

constexpr std::size_t k_max_excerpt = 160;  // characters; longer lines are not shown

/// "/scene/shape[2]/bsdf": the index counts elements of the same name, from 1, and is left out where there is one only.
std::string element_path(pugi::xml_node node) {
  std::string path;
  for (; node.type() == pugi::node_element; node = node.parent()) {
    std::size_t index = 1, count = 0;
    for (const pugi::xml_node sibling : node.parent().children(node.name())) {
      ++count;
      if (sibling == node) index = count;
    }
    path = count > 1 ? fmt::format("/{}[{}]{}", node.name(), index, path) : fmt::format("/{}{}", node.name(), path);
  }
  return path;
}

bool is_name_character(char c) {
  return c != '=' && c != '>' && c != '/' && std::string_view(" \t\r\n").find(c) == std::string_view::npos;
}

/// Offset of an attribute's name within the start tag that begins at `begin`; `begin` where it is not found.
std::size_t find_attribute(std::string_view text, std::size_t begin, std::string_view name) {
  char quote = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    const char c = text[i];
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      break;
    } else if (!is_name_character(text[i > 0 ? i - 1 : 0]) && text.substr(i, name.size()) == name &&
               i + name.size() < text.size() && !is_name_character(text[i + name.size()])) {
      return i;
    }
  }
  return begin;
}

}  // namespace

XmlDocument::XmlDocument(const std::filesystem::path& file) : XmlDocument(file.string(), read_file(file)) {}

XmlDocument::XmlDocument(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {
  const pugi::xml_parse_result result =
      document_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result)
    throw_input_error(position_of_byte(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))),
                      fmt::format("not well-formed XML: {}", result.description()));
}

SourcePosition XmlDocument::position(pugi::xml_node node, std::string_view attribute) const {
  const std::ptrdiff_t offset = node.offset_debug();
  SourcePosition where{.file = file_, .pointer = {}, .excerpt = {}};
  if (offset >= 0) {
    const auto begin = static_cast<std::size_t>(offset);
    where = position_of_byte(attribute.empty() ? begin : find_attribute(text_, begin, attribute));
  }
  where.pointer = element_path(node);
  return where;
}

SourcePosition XmlDocument::position_of_byte(std::size_t offset) const {
  const std::string_view text = text_;
  offset = std::min(offset, text.size());
  const std::string_view before = text.substr(0, offset);
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 = 0
  const std::size_t line_end = std::min(text.find('\n', offset), text.size());
  SourcePosition where{.file = file_, .pointer = {}, .excerpt = {}};
  where.line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1;
  where.column = static_cast<int>(offset - line_begin) + 1;
  if (line_end - line_begin <= k_max_excerpt) {
    where.excerpt = std::string(text.substr(line_begin, line_end - line_begin));
    std::replace(where.excerpt.begin(), where.excerpt.end(), '\t', ' ');
    if (!where.excerpt.empty() && where.excerpt.back() == '\r') where.excerpt.pop_back();
  }
  return where;
}

}  // namespace gradslc
