#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/rgb.h"

namespace gradslc {

/// Index of refraction of a dielectric by its name in Mitsuba's documentation ("bk7", "water", "air" ...), in any case;
/// nullopt where it is unknown.
std::optional<float> dielectric_index(std::string_view name);
std::vector<std::string> dielectric_names();

/// Complex index of refraction eta + i k, per channel, in vacuum.
struct ConductorIndex {
  Rgb eta, k;
};
/// By the name of the material in Mitsuba's documentation ("Cu", "Ag" ...; "none" is a perfect mirror); nullopt where
/// it is unknown.
std::optional<ConductorIndex> conductor_index(std::string_view name);
std::vector<std::string> conductor_names();

}  // namespace gradslc
