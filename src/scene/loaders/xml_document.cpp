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

XmlDocument::XmlDocument(std::string file, std::string text)
    : file_(std::move(file)), text_(std::move(text)), line_begins_{0} {
  for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n', end + 1))
    line_begins_.push_back(end + 1);
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

int XmlDocument::line(pugi::xml_node node) const {
  return static_cast<int>(line_index(static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)))) + 1;
}

std::size_t XmlDocument::line_index(std::size_t offset) const {
  const auto next = std::upper_bound(line_begins_.begin(), line_begins_.end(), offset);
  return static_cast<std::size_t>(next - line_begins_.begin()) - 1;
}

SourcePosition XmlDocument::position_of_byte(std::size_t offset) const {
  offset = std::min(offset, text_.size());
  const std::size_t line = line_index(offset), begin = line_begins_[line];
  const std::size_t end = line + 1 < line_begins_.size() ? line_begins_[line + 1] - 1 : text_.size();
  SourcePosition where{.file = file_, .pointer = {}, .excerpt = {}};
  where.line = static_cast<int>(line) + 1;
  where.column = static_cast<int>(offset - begin) + 1;
  if (end - begin <= k_max_excerpt) {
    where.excerpt = text_.substr(begin, end - begin);
    std::replace(where.excerpt.begin(), where.excerpt.end(), '\t', ' ');
    if (where.excerpt.ends_with('\r')) where.excerpt.pop_back();
  }
  return where;
}

}  // namespace gradslc
