#include "experiments/json_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/file.h"

namespace gradslc {
namespace {

using nlohmann::json;

constexpr std::string_view k_byte_order_mark = "\xef\xbb\xbf";
constexpr std::size_t k_longest_excerpt = 160;
constexpr std::size_t k_longest_reason = 200;

/// The pointer of the enclosing value; `pointer` is not empty.
std::string parent_of(const std::string& pointer) { return pointer.substr(0, pointer.rfind('/')); }

std::string key_of(const std::string& pointer) { return json::json_pointer(pointer).back(); }

bool continues_character(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }

/// `text` with ill-formed UTF-8 shown as U+FFFD: a message must be text.
std::string well_formed(const std::string& text) {
  const std::string quoted = json(text).dump(-1, ' ', false, json::error_handler_t::replace);
  return json::parse(quoted).get<std::string>();
}

/// Reads the text without building anything, to learn where it is wrong.
class SyntaxCheck final : public nlohmann::json_sax<json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t read, const std::string& /*token*/, const json::exception& error) override {
    offset = read > 0 ? read - 1 : 0;
    reason = without_preamble(error.what());
    return false;
  }

  std::size_t offset = 0;  ///< of the last byte that was read
  std::string reason;

 private:
  /// nlohmann-json's text without its "[json.exception...] parse error at line 1, column 2: ".
  static std::string without_preamble(std::string_view what) {
    if (const auto end = what.find("] "); end != what.npos) what.remove_prefix(end + 2);
    if (what.starts_with("parse error at"))
      if (const auto end = what.find(": "); end != what.npos) what.remove_prefix(end + 2);
    std::string reason(what);
    if (reason.size() > k_longest_reason) reason = reason.substr(0, k_longest_reason) + " ...";
    if (reason.find("invalid literal") != reason.npos) reason += " (JSON has no NaN or infinity)";
    return well_formed(reason);
  }
};

}  // namespace

std::string join_pointer(std::string_view pointer, std::string_view key) {
  std::string joined(pointer);
  joined += '/';
  for (const char c : key) {
    if (c == '~')
      joined += "~0";
    else if (c == '/')
      joined += "~1";
    else
      joined += c;
  }
  return joined;
}

std::string join_pointer(std::string_view pointer, std::size_t index) { return fmt::format("{}/{}", pointer, index); }

/// Finds where each key and value of a text stands that is known to be JSON.
class JsonDocument::Scanner {
 public:
  explicit Scanner(JsonDocument& document) : document_(document), text_(document.text_) {
    if (text_.starts_with(k_byte_order_mark)) at_ = k_byte_order_mark.size();
    scan_value("", 0);
  }

 private:
  void scan_value(const std::string& pointer, int nesting) {
    skip_blanks();
    document_.places_[pointer].value = at_;
    if (text_[at_] == '{' || text_[at_] == '[') {
      if (nesting == k_max_nesting)
        throw_input_error(document_.text_position(at_, {}), fmt::format("nested deeper than {} levels", k_max_nesting));
      if (text_[at_] == '{')
        scan_object(pointer, nesting);
      else
        scan_array(pointer, nesting);
    } else if (text_[at_] == '"') {
      skip_string();
    } else {
      while (at_ < text_.size() && std::string_view(",]}/ \t\r\n").find(text_[at_]) == std::string_view::npos) ++at_;
    }
  }

  void scan_object(const std::string& pointer, int nesting) {
    ++at_;
    for (skip_blanks(); text_[at_] != '}'; skip_blanks()) {
      const std::size_t key_begin = at_;
      skip_string();
      const std::string key = json::parse(text_.substr(key_begin, at_ - key_begin)).get<std::string>();
      const std::string member = join_pointer(pointer, key);
      if (const auto first = document_.places_.find(member); first != document_.places_.end())
        throw_input_error(
            document_.text_position(key_begin, member),
            fmt::format("key is given twice, first on line {}", document_.text_position(*first->second.key, {}).line));
      document_.places_[member].key = key_begin;
      skip_blanks();
      ++at_;  // the colon
      scan_value(member, nesting + 1);
      skip_comma();
    }
    ++at_;
  }

  void scan_array(const std::string& pointer, int nesting) {
    ++at_;
    skip_blanks();
    for (std::size_t index = 0; text_[at_] != ']'; ++index) {
      scan_value(join_pointer(pointer, index), nesting + 1);
      skip_comma();
      skip_blanks();
    }
    ++at_;
  }

  void skip_string() {
    for (++at_; text_[at_] != '"'; ++at_)
      if (text_[at_] == '\\') ++at_;
    ++at_;
  }

  void skip_comma() {
    skip_blanks();
    if (text_[at_] == ',') ++at_;
  }

  void skip_blanks() {
    while (at_ < text_.size()) {
      if (std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) {
        ++at_;
      } else if (text_.compare(at_, 2, "//") == 0) {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (text_.compare(at_, 2, "/*") == 0) {
        at_ = text_.find("*/", at_ + 2) + 2;
      } else {
        return;
      }
    }
  }

  JsonDocument& document_;
  const std::string& text_;
  std::size_t at_ = 0;
};

JsonDocument JsonDocument::parse(std::string name, std::string text) {
  JsonDocument document;
  document.name_ = std::move(name);
  document.text_ = std::move(text);
  SyntaxCheck check;
  if (!json::sax_parse(document.text_, &check, json::input_format_t::json, true, true))
    throw_input_error(document.text_position(check.offset, {}), check.reason);
  Scanner{document};
  document.root_ = json::parse(document.text_, nullptr, true, true);
  return document;
}

JsonDocument JsonDocument::read(const std::filesystem::path& file) { return parse(file.string(), read_file(file)); }

JsonDocument JsonDocument::from_value(std::string name, nlohmann::json value) {
  JsonDocument document;
  document.name_ = std::move(name);
  document.root_ = std::move(value);
  return document;
}

const nlohmann::json* JsonDocument::find(const std::string& pointer) const {
  const json::json_pointer parsed(pointer);
  return root_.contains(parsed) ? &root_.at(parsed) : nullptr;
}

SourcePosition JsonDocument::text_position(std::size_t offset, std::string pointer) const {
  offset = std::min(offset, text_.size());
  const auto begin_of_text = text_.begin(), at = begin_of_text + static_cast<std::ptrdiff_t>(offset);
  SourcePosition where{.file = name_, .pointer = std::move(pointer), .excerpt = {}};
  where.line = 1 + static_cast<int>(std::count(begin_of_text, at, '\n'));
  const auto before = std::find(std::make_reverse_iterator(at), std::make_reverse_iterator(begin_of_text), '\n');
  auto line = before.base();
  if (where.line == 1 && text_.starts_with(k_byte_order_mark))
    line += std::min<std::ptrdiff_t>(at - line, k_byte_order_mark.size());
  where.column = 1 + static_cast<int>(std::count_if(line, at, [](char c) { return !continues_character(c); }));
  std::string excerpt(line, std::find(line, text_.end(), '\n'));
  for (char& c : excerpt)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  while (!excerpt.empty() && excerpt.back() == ' ') excerpt.pop_back();
  if (excerpt.size() <= k_longest_excerpt) where.excerpt = well_formed(excerpt);
  return where;
}

const std::string* JsonDocument::replaced_by(const std::string& pointer) const {
  for (std::string enclosing = pointer;; enclosing = parent_of(enclosing)) {
    if (const auto found = replaced_.find(enclosing); found != replaced_.end()) return &found->second;
    if (enclosing.empty()) return nullptr;
  }
}

SourcePosition JsonDocument::position(const std::string& pointer) const {
  if (const std::string* origin = replaced_by(pointer)) return {.file = *origin, .pointer = pointer, .excerpt = {}};
  for (std::string enclosing = pointer;; enclosing = parent_of(enclosing)) {
    if (const auto found = places_.find(enclosing); found != places_.end())
      return text_position(found->second.value, pointer);
    if (enclosing.empty()) return {.file = name_, .pointer = pointer, .excerpt = {}};
  }
}

SourcePosition JsonDocument::key_position(const std::string& pointer) const {
  const auto found = places_.find(pointer);
  if (replaced_by(pointer) || found == places_.end() || !found->second.key) return position(pointer);
  return text_position(*found->second.key, pointer);
}

void JsonDocument::replace(const std::string& pointer, nlohmann::json value, const std::string& origin) {
  const auto refuse = [&](const std::string& message) {
    throw_input_error(SourcePosition{.file = origin, .pointer = pointer, .excerpt = {}}, message);
  };
  std::vector<std::string> keys;
  for (std::string rest = pointer; !rest.empty(); rest = parent_of(rest)) keys.push_back(key_of(rest));
  json* target = &root_;
  for (auto key = keys.rbegin(); key != keys.rend(); ++key) {
    if (target->is_null()) *target = json::object();
    if (target->is_object()) {
      target = &(*target)[*key];
    } else if (target->is_array()) {
      const bool number =
          !key->empty() && std::all_of(key->begin(), key->end(), [](char c) { return c >= '0' && c <= '9'; });
      if (!number || key->size() > 9 || std::stoul(*key) >= target->size())
        refuse(fmt::format("\"{}\" is not an element of an array of {}", *key, target->size()));
      target = &(*target)[std::stoul(*key)];
    } else {
      refuse(fmt::format("\"{}\" lies within {}, which has no keys", *key, target->dump()));
    }
  }
  *target = std::move(value);
  replaced_[pointer] = origin;
}

}  // namespace gradslc
