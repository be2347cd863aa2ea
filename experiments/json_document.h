#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace gradslc {

/// `pointer` extended by a key or an index: a JSON pointer (RFC 6901).
std::string join_pointer(std::string_view pointer, std::string_view key);
std::string join_pointer(std::string_view pointer, std::size_t index);

/// A JSON value that knows where in its text each part of it stands. Comments are allowed.
class JsonDocument {
 public:
  static constexpr int k_max_nesting = 64;

  /// `name` is what errors call the text: a file or an option. Throws Error (input) with line and column where the text
  /// is not JSON, gives a key twice, is not UTF-8, nests deeper than k_max_nesting or holds a number beyond a double.
  static JsonDocument parse(std::string name, std::string text);
  static JsonDocument read(const std::filesystem::path& file);
  /// A value without text: errors name `name` and the pointer only.
  static JsonDocument from_value(std::string name, nlohmann::json value);

  const nlohmann::json& root() const { return root_; }
  /// nullptr where the document has no such value.
  const nlohmann::json* find(const std::string& pointer) const;

  /// Where the value stands; for one that is missing, its nearest enclosing value.
  SourcePosition position(const std::string& pointer) const;
  /// Where the key of a member of an object stands.
  SourcePosition key_position(const std::string& pointer) const;

  /// Puts `value` at `pointer`, making the objects on the way. Errors about it call it `origin` from now on.
  /// Throws Error (input) where an array has no such element or the way leads through another kind of value.
  void replace(const std::string& pointer, nlohmann::json value, const std::string& origin);

 private:
  struct Place {  // byte offsets into text_
    std::size_t value = 0;
    std::optional<std::size_t> key;
  };
  using Places = std::map<std::string, Place, std::less<>>;
  class Scanner;

  SourcePosition text_position(std::size_t offset, std::string pointer) const;
  /// What replace() called the value at `pointer` or one around it; nullptr: it stands in the text.
  const std::string* replaced_by(const std::string& pointer) const;

  std::string name_, text_;
  nlohmann::json root_;
  Places places_;                                // by pointer
  std::map<std::string, std::string> replaced_;  // pointer to origin
};

}  // namespace gradslc
