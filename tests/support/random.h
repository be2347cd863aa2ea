#pragma once

#include <cstdint>
#include <random>

#include "core/hash.h"
#include "core/vec.h"
#include "core/warp.h"

namespace gradslc {

/// Random numbers for tests, with the same bits on every platform and nothing in common with the project's samplers.
class TestRandom {
 public:
  explicit TestRandom(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  /// In [0,1).
  float get1() { return to_unit_float(static_cast<std::uint32_t>(engine_() >> 32)); }
  Vec2 get2() {
    const float x = get1();
    const float y = get1();
    return {x, y};
  }
  /// In [0,1), 53 bits.
  double get1_double() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// In [0, bound), bound > 0.
  std::size_t below(std::size_t bound) { return engine_() % bound; }
  /// Uniform on the sphere.
  Vec3 direction() { return square_to_sphere(get2()); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace gradslc
