#include "shifts/registry.h"

namespace gradslc {
namespace {

constexpr ShiftEntry k_shifts[] = {
    {"reconnection", "base and offsets connect to the same VPLs, chosen by a law shared over all of them"},
    {"random_replay", "every pixel of a block or tile repeats its own selection with the same random numbers"},
    {"block", "all pixels of a block connect to the same VPLs, chosen by a law shared over them"},
};

}  // namespace

std::span<const ShiftEntry> shift_registry() { return k_shifts; }

std::vector<std::string> shift_names() {
  std::vector<std::string> names;
  for (const ShiftEntry& entry : k_shifts) names.emplace_back(entry.name);
  return names;
}

}  // namespace gradslc
