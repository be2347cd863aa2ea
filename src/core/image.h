#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

#include "core/rgb.h"

namespace gradslc {

/// A pixel: column x from the left, row y from the top.
struct Pixel {
  int x = 0, y = 0;
  bool operator==(const Pixel&) const = default;
};
constexpr Pixel operator+(Pixel a, Pixel b) { return {a.x + b.x, a.y + b.y}; }

struct Resolution {
  int width = 0, height = 0;
  bool operator==(const Resolution&) const = default;
  constexpr std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  constexpr bool contains(Pixel p) const { return p.x >= 0 && p.y >= 0 && p.x < width && p.y < height; }
  constexpr std::size_t index(Pixel p) const {
    return static_cast<std::size_t>(p.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(p.x);
  }
  constexpr Pixel pixel(std::size_t i) const {
    const auto columns = static_cast<std::size_t>(width);
    return {static_cast<int>(i % columns), static_cast<int>(i / columns)};
  }
};

/// A row-major image, origin top left.
template <class T>
class Image {
 public:
  Image() = default;
  explicit Image(Resolution resolution, const T& fill = T())
      : resolution_(resolution), data_(resolution.pixels(), fill) {}

  Resolution resolution() const { return resolution_; }
  int width() const { return resolution_.width; }
  int height() const { return resolution_.height; }
  std::size_t size() const { return data_.size(); }
  bool empty() const { return data_.empty(); }

  T& operator()(int x, int y) { return (*this)[Pixel{x, y}]; }
  const T& operator()(int x, int y) const { return (*this)[Pixel{x, y}]; }
  T& operator[](Pixel p) {
    assert(resolution_.contains(p));
    return data_[resolution_.index(p)];
  }
  const T& operator[](Pixel p) const {
    assert(resolution_.contains(p));
    return data_[resolution_.index(p)];
  }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  auto begin() { return data_.begin(); }
  auto end() { return data_.end(); }
  auto begin() const { return data_.begin(); }
  auto end() const { return data_.end(); }
  bool operator==(const Image&) const = default;

 private:
  Resolution resolution_;
  std::vector<T> data_;
};

using RgbImage = Image<Rgb>;

}  // namespace gradslc
