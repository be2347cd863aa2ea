#include "scene/loaders/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

#include "core/error.h"
#include "scene/loaders/mesh_file.h"

namespace gradslc {
namespace {

constexpr std::size_t k_max_properties = 1000;  // of one element; more is a damaged file

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr TypeName k_types[] = {
    {"char", PlyType::int8},      {"uchar", PlyType::uint8},    {"short", PlyType::int16},
    {"ushort", PlyType::uint16},  {"int", PlyType::int32},      {"uint", PlyType::uint32},
    {"float", PlyType::float32},  {"double", PlyType::float64}, {"int8", PlyType::int8},
    {"uint8", PlyType::uint8},    {"int16", PlyType::int16},    {"uint16", PlyType::uint16},
    {"int32", PlyType::int32},    {"uint32", PlyType::uint32},  {"float32", PlyType::float32},
    {"float64", PlyType::float64}};

struct FormatName {
  std::string_view name;
  PlyFormat format;
};
constexpr FormatName k_formats[] = {{"ascii", PlyFormat::ascii},
                                    {"binary_little_endian", PlyFormat::binary_little_endian},
                                    {"binary_big_endian", PlyFormat::binary_big_endian}};

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  PlyHeader parse() {
    next_line();
    if (word() != "ply" || !at_line_end()) fail(0, "is not a PLY file: its first line must be \"ply\"");
    bool has_format = false;
    for (;;) {
      next_line();
      const std::size_t begin = position_;
      const std::string_view keyword = word();
      if (keyword == "end_header") break;
      if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) continue;
      if (keyword == "format") {
        read_format();
        has_format = true;
      } else if (keyword == "element") {
        read_element();
      } else if (keyword == "property") {
        read_property(begin);
      } else {
        fail(begin, fmt::format("unknown word \"{:.20}\" in the header; known: format, element, property, comment, "
                                "obj_info, end_header",
                                keyword));
      }
      if (!at_line_end()) fail(position_, "the line should end here");
    }
    if (!has_format) fail(position_, "the header has no line \"format\"");
    header_.size = next_begin_;
    return std::move(header_);
  }

 private:
  void next_line() {
    position_ = next_begin_;
    line_end_ = bytes_.find('\n', position_);
    if (line_end_ == std::string_view::npos) fail(bytes_.size(), "the header has no line \"end_header\"");
    next_begin_ = line_end_ + 1;
  }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  bool at_line_end() {
    while (position_ < line_end_ && is_blank(bytes_[position_])) ++position_;
    return position_ == line_end_;
  }
  std::string_view word() {
    if (at_line_end()) return {};
    const std::size_t begin = position_;
    while (position_ < line_end_ && !is_blank(bytes_[position_])) ++position_;
    return bytes_.substr(begin, position_ - begin);
  }

  void read_format() {
    const std::size_t begin = position_;
    const std::string_view name = word();
    const auto found = std::find_if(std::begin(k_formats), std::end(k_formats),
                                    [&](const FormatName& candidate) { return candidate.name == name; });
    if (found == std::end(k_formats))
      fail(begin,
           fmt::format("unknown format \"{:.30}\"; known: ascii, binary_little_endian, binary_big_endian", name));
    header_.format = found->format;
    if (word() != "1.0") fail(begin, "the format's version must be 1.0");
  }
  void read_element() {
    PlyElement element{.name = std::string(word()), .count = 0, .properties = {}};
    if (element.name.empty()) fail(position_, "an element needs a name and a count");
    if (header_.find(element.name)) fail(position_, fmt::format("element \"{:.30}\" is given twice", element.name));
    at_line_end();
    const std::size_t begin = position_;
    const std::string_view text = word();
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), element.count);
    if (failure != std::errc() || end != text.data() + text.size())
      fail(begin, fmt::format("the count of element \"{:.30}\" must be a whole number", element.name));
    header_.elements.push_back(std::move(element));
  }
  void read_property(std::size_t begin) {
    if (header_.elements.empty()) fail(begin, "a property must follow an element");
    PlyElement& element = header_.elements.back();
    if (element.properties.size() == k_max_properties)
      fail(begin, fmt::format("an element has at most {} properties", k_max_properties));
    PlyProperty property;
    at_line_end();
    const std::size_t type = position_;
    if (word() == "list") {
      property.count_type = read_type();
      if (*property.count_type == PlyType::float32 || *property.count_type == PlyType::float64)
        fail(type, "the count of a list must be of a whole type");
    } else {
      position_ = type;
    }
    property.type = read_type();
    property.name = std::string(word());
    if (property.name.empty()) fail(position_, "a property needs a type and a name");
    element.properties.push_back(std::move(property));
  }
  PlyType read_type() {
    at_line_end();
    const std::size_t begin = position_;
    const std::string_view name = word();
    for (const TypeName& candidate : k_types)
      if (candidate.name == name) return candidate.type;
    fail(begin,
         fmt::format("unknown type \"{:.20}\"; known: char, uchar, short, ushort, int, uint, float, double", name));
  }
  [[noreturn]] void fail(std::size_t position, std::string message) const {
    throw_input_error(position_in_text(bytes_, file_, position), std::move(message));
  }

  std::string_view bytes_;
  const std::string& file_;
  PlyHeader header_;
  std::size_t position_ = 0, line_end_ = 0, next_begin_ = 0;
};

}  // namespace

std::size_t ply_size(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      break;
  }
  return 8;
}

const PlyElement* PlyHeader::find(std::string_view name) const {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const PlyElement& element) { return element.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& file) {
  return HeaderParser(bytes, file).parse();
}

}  // namespace gradslc
