#include "scene/loaders/mitsuba_values.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace gradslc {
namespace {

constexpr std::string_view k_blanks = " \t\r\n";

std::string_view trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(k_blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(k_blanks) + 1 - begin);
}

template <class Number>
std::optional<Number> parse(std::string_view text) {
  text = trim(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Reads the steps of one <transform>.
class StepReader {
 public:
  StepReader(const MitsubaDocument& document, const XmlElement& step) : document_(document), step_(step) {}

  Transform read() const {
    const std::string_view tag = step_.node.name();
    if (tag == "translate") return translate();
    if (tag == "rotate") return rotate();
    if (tag == "scale") return scale();
    if (tag == "matrix") return matrix();
    if (tag == "lookat" || tag == "lookAt") return look_at();
    document_.fail(step_, fmt::format("unknown transform <{}>; known: translate, rotate, scale, matrix, lookat", tag));
  }

 private:
  double number(const char* name, double default_value) const {
    if (!step_.node.attribute(name)) return default_value;
    const std::optional<double> number = parse_number(document_.attribute(step_, name));
    if (!number) document_.fail(step_, fmt::format("{} must be a number", name), name);
    return *number;
  }
  std::vector<double> numbers(const char* name) const {
    const auto numbers = parse_numbers(document_.required_attribute(step_, name));
    if (!numbers) document_.fail(step_, fmt::format("{} must be numbers", name), name);
    return *numbers;
  }
  Vec3 triple(const char* name) const {
    const std::vector<double> v = numbers(name);
    if (v.size() != 3) document_.fail(step_, fmt::format("{} must be three numbers, not {}", name, v.size()), name);
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  }
  /// x, y and z, from attributes of these names or from `value`.
  std::array<double, 3> xyz(double default_value) const {
    if (!step_.node.attribute("value"))
      return {number("x", default_value), number("y", default_value), number("z", default_value)};
    const std::vector<double> v = numbers("value");
    if (v.size() == 1 && std::string_view(step_.node.name()) == "scale") return {v[0], v[0], v[0]};
    if (v.size() != 3) document_.fail(step_, fmt::format("value must be three numbers, not {}", v.size()), "value");
    return {v[0], v[1], v[2]};
  }

  Transform translate() const {
    const auto [x, y, z] = xyz(0);
    return Transform::translation(x, y, z);
  }
  Transform scale() const {
    const auto [x, y, z] = xyz(1);
    return Transform::scaling(x, y, z);
  }
  Transform rotate() const {
    const auto [x, y, z] = xyz(0);
    if (x == 0 && y == 0 && z == 0) document_.fail(step_, "the axis of a rotation must not be zero");
    document_.required_attribute(step_, "angle");
    return Transform::rotation(x, y, z, number("angle", 0));
  }
  Transform matrix() const {
    const std::vector<double> v = numbers("value");
    const std::size_t n = v.size() == 9 ? 3 : 4;
    if (v.size() != n * n)
      document_.fail(step_, fmt::format("a matrix has 16 (or 9) numbers, row by row, not {}", v.size()), "value");
    std::array<std::array<double, 4>, 3> rows{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < n; ++j) rows[i][j] = v[i * n + j];
    if (n == 4 && (v[12] != 0 || v[13] != 0 || v[14] != 0 || v[15] != 1))
      document_.fail(step_, "the last row of a matrix must be 0 0 0 1", "value");
    return Transform(rows);
  }
  Transform look_at() const {
    const Vec3 origin = triple("origin"), target = triple("target");
    const Vec3 up = step_.node.attribute("up") ? triple("up") : Vec3{0, 1, 0};
    const auto transform = Transform::look_at(Point3() + origin, Point3() + target, up);
    if (!transform)
      document_.fail(step_,
                     "origin, target and up do not define a direction: target equals origin, or up is parallel to it");
    return *transform;
  }

  const MitsubaDocument& document_;
  const XmlElement& step_;
};

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const std::optional<double> value = parse<double>(text);
  return value && std::isfinite(*value) && std::isfinite(static_cast<float>(*value)) ? value : std::nullopt;
}

std::optional<int> parse_integer(std::string_view text) { return parse<int>(text); }

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (text = trim(text); !text.empty();) {
    const std::size_t end = std::min(text.find_first_of(", \t\r\n"), text.size());
    const std::optional<double> number = parse_number(text.substr(0, end));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    text = trim(text.substr(end));
    if (!text.empty() && text.front() == ',') text = trim(text.substr(1));
  }
  return numbers;
}

std::optional<Rgb> parse_hex_colour(std::string_view text) {
  text = trim(text);
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  unsigned int bits = 0;
  const auto [end, failure] = std::from_chars(text.data() + 1, text.data() + 7, bits, 16);
  if (failure != std::errc() || end != text.data() + 7) return std::nullopt;
  const auto channel = [&](unsigned int shift) {
    return srgb_to_linear(static_cast<float>((bits >> shift) & 0xff) / 255);
  };
  return Rgb(channel(16), channel(8), channel(0));
}

Transform read_transform(const MitsubaDocument& document, const XmlElement& element) {
  Transform transform;
  for (const pugi::xml_node node : element.node.children()) {
    if (node.type() != pugi::node_element) continue;
    const XmlElement step{element.document, node};
    transform = StepReader(document, step).read() * transform;
  }
  if (!transform.is_finite()) document.fail(element, "the transform is not finite");
  return transform;
}

}  // namespace gradslc
