#include "materials/checkerboard.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gradslc {
namespace {

bool in_upper_half(float t) { return t - std::floor(t) >= 0.5f; }

class Checkerboard final : public TextureMap {
 public:
  Checkerboard(Texture first, Texture second, const UvTransform& to_uv)
      : first_(std::move(first)), second_(std::move(second)), to_uv_(to_uv) {}

  Rgb eval(Vec2 uv) const override { return colour_at(uv).eval(uv); }
  Vec2 gradient(Vec2 uv) const override { return colour_at(uv).gradient(uv); }
  Rgb max_value() const override {
    const Rgb a = first_.max_value(), b = second_.max_value();
    return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)};
  }
  Rgb min_value() const override {
    const Rgb a = first_.min_value(), b = second_.min_value();
    return {std::min(a.r, b.r), std::min(a.g, b.g), std::min(a.b, b.b)};
  }
  std::size_t memory_bytes() const override {
    std::size_t bytes = sizeof(Checkerboard);
    for (const Texture* colour : {&first_, &second_})
      if (colour->map()) bytes += colour->map()->memory_bytes();
    return bytes;
  }

 private:
  const Texture& colour_at(Vec2 uv) const {
    const auto [u, v] = to_uv_.apply(uv);
    return in_upper_half(u) == in_upper_half(v) ? first_ : second_;
  }

  Texture first_, second_;
  UvTransform to_uv_;
};

}  // namespace

std::shared_ptr<const TextureMap> make_checkerboard(Texture first, Texture second, const UvTransform& to_uv) {
  return std::make_shared<Checkerboard>(std::move(first), std::move(second), to_uv);
}

}  // namespace gradslc
