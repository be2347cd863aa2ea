#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/rgb.h"
#include "scene/loaders/mitsuba_document.h"
#include "scene/loaders/transform.h"

namespace gradslc {

/// A finite number that fills the text but for blanks; nullopt otherwise.
std::optional<double> parse_number(std::string_view text);
std::optional<int> parse_integer(std::string_view text);
/// Numbers separated by commas or blanks; nullopt where one is malformed.
std::optional<std::vector<double>> parse_numbers(std::string_view text);
/// "#rrggbb", sRGB-encoded, as linear RGB.
std::optional<Rgb> parse_hex_colour(std::string_view text);

/// Value of a <transform>: its steps in the order of the file, the first one applied first.
Transform read_transform(const MitsubaDocument& document, const XmlElement& element);

}  // namespace gradslc
