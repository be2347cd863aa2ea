#pragma once

#include <cstddef>
#include <memory>

#include "reconstruction/rows.h"

namespace gradslc {

inline constexpr std::size_t k_field_channels = 3;

/// Values of three channels: planes, one after the other, row-major. Not initialised, so that the threads that first
/// write to memory are those that go on with it.
template <class T>
class PlanarField {
 public:
  PlanarField() = default;
  explicit PlanarField(Resolution resolution)
      : size_(k_field_channels * resolution.pixels()), values_(std::make_unique_for_overwrite<T[]>(size_)) {}

  std::size_t size() const { return size_; }
  T* begin() { return values_.get(); }
  T* end() { return begin() + size_; }
  const T* begin() const { return values_.get(); }
  const T* end() const { return begin() + size_; }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }

 private:
  std::size_t size_ = 0;
  std::unique_ptr<T[]> values_;
};
using Field = PlanarField<float>;

/// Calls body(y, index of the row's first value) for all rows of all channels.
template <class Body>
void for_each_channel_row(Resolution resolution, const Body& body) {
  for_each_row(resolution, [&](int y) {
    for (std::size_t channel = 0; channel < k_field_channels; ++channel)
      body(y, channel * resolution.pixels() + resolution.index({0, y}));
  });
}

}  // namespace gradslc
