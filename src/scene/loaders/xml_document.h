#pragma once

#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace gradslc {

/// A parsed XML file that knows where in the text each node stands.
class XmlDocument {
 public:
  /// Throws Error (input) with line and column where the file cannot be read or is not well-formed.
  explicit XmlDocument(const std::filesystem::path& file);
  /// The same for text in memory; `file` is its name in messages.
  XmlDocument(std::string file, std::string text);
  XmlDocument(const XmlDocument&) = delete;
  XmlDocument& operator=(const XmlDocument&) = delete;

  const std::string& file() const { return file_; }
  pugi::xml_node root() const { return document_.document_element(); }
  /// Position of an element, or of one of its attributes where `attribute` names one that it has.
  SourcePosition position(pugi::xml_node node, std::string_view attribute = {}) const;
  /// Line of an element, from 1.
  int line(pugi::xml_node node) const;

 private:
  std::size_t line_index(std::size_t offset) const;  // from 0
  SourcePosition position_of_byte(std::size_t offset) const;

  std::string file_, text_;
  std::vector<std::size_t> line_begins_;
  pugi::xml_document document_;
};

/// An element and the document that it stands in.
struct XmlElement {
  const XmlDocument* document = nullptr;
  pugi::xml_node node;
  bool operator==(const XmlElement&) const = default;
};

}  // namespace gradslc
