#include "shifts/registry.h"

namespace gradslc {
namespace {

constexpr ShiftEntry k_shifts[] = {
    {"reconnection", "base and offsets connect to the same VPLs, chosen by a law shared over all of them"},
    {"random_replay", "every pixel of a block repeats its own selection with the block's random numbers"},
};

}  // namespace

std::span<const ShiftEntry> shift_registry() { return k_shifts; }

std::vector<std::string> shift_names() {
  std::vector<std::string> names;
  for (const ShiftEntry& entry : k_shifts) names.emplace_back(entry.name);
  return names;
}

}  // namespace gradslc
