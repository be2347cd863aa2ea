#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "core/vec.h"

namespace gradslc {

/// Why an offset path does not exist, or carries nothing.
enum class ShiftFailure : std::uint8_t {
  occluded,                   ///< something stands between the offset vertex and the base's next one
  back_facing,                ///< the direction is on another side of a surface than the base's
  not_connectable,            ///< vertices of base and offset are not of the same kind
  degenerate,                 ///< coinciding vertices, a surface seen edge-on
  total_internal_reflection,  ///< the copied half vector refracts the offset's direction nowhere
  left_scene,                 ///< the offset's ray meets no surface where the base's does
  black,                      ///< the offset's lobes scatter nothing that way
};
constexpr std::size_t k_shift_failure_count = 7;
/// As in the names of counters.
constexpr const char* k_shift_failure_names[k_shift_failure_count] = {
    "occluded", "back_facing", "not_connectable", "degenerate", "total_internal_reflection", "left_scene", "black"};

/// What a shift returns: a value, or why there is none.
template <class T>
class ShiftResult {
 public:
  ShiftResult(const T& value) : result_(value) {}          // NOLINT(google-explicit-constructor)
  ShiftResult(ShiftFailure failure) : result_(failure) {}  // NOLINT(google-explicit-constructor)

  explicit operator bool() const { return std::holds_alternative<T>(result_); }
  const T& operator*() const {
    assert(*this);
    return *std::get_if<T>(&result_);
  }
  const T* operator->() const { return &**this; }
  ShiftFailure failure() const {
    assert(!*this);
    return *std::get_if<ShiftFailure>(&result_);
  }

 private:
  std::variant<T, ShiftFailure> result_;
};

/// The offset's direction at a vertex and |dw'/dw|, both directions' solid angles: > 0, finite.
struct ShiftedDirection {
  Vec3 direction;
  float jacobian;
};

}  // namespace gradslc
