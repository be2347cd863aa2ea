#pragma once

#include <cstdint>

#include "core/hash.h"

namespace gradslc {

/// Where a pass belongs: the two halves alternate by VPL set (by pass where a method has none, or one set for the whole
/// run), and each half counts its own sets and samples, so that each is a sequence of its own (DESIGN 6).
struct PassSlot {
  int half = 0;
  std::uint32_t set = 0;     ///< VPL set within the half
  std::uint32_t sample = 0;  ///< pass within the half: index of the half's sample sequences
  bool closes_set = true;    ///< last pass of its set (every pass, where one set serves the whole run)
  std::uint32_t pass = 0;    ///< of the whole run
};

/// `passes_per_set` 0: one set for the whole run, shared by both halves.
constexpr PassSlot pass_slot(std::uint32_t pass, std::uint32_t passes_per_set) {
  if (passes_per_set == 0) return {static_cast<int>(pass % 2), 0, pass / 2, true, pass};
  const std::uint32_t set = pass / passes_per_set, within = pass % passes_per_set;
  return {static_cast<int>(set % 2), set / 2, set / 2 * passes_per_set + within, within + 1 == passes_per_set, pass};
}

/// What a seed is used for: streams of different purposes are independent.
enum class SeedPurpose : std::uint64_t { camera = 1, light_paths, pilot, tiles, adapted_camera, representatives };

constexpr std::uint64_t derive_seed(std::uint64_t seed, SeedPurpose purpose, int half) {
  return hash_combine(seed, static_cast<std::uint64_t>(purpose), static_cast<std::uint64_t>(half));
}

}  // namespace gradslc
