#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gradslc {

/// How neighbours' samples are made alike (DESIGN 6).
enum class Shift : std::uint8_t { reconnection, random_replay, block };

struct ShiftEntry {
  const char* name;
  const char* meaning;
};
/// The only list of shifts, in the order of Shift.
std::span<const ShiftEntry> shift_registry();
std::vector<std::string> shift_names();

}  // namespace gradslc
