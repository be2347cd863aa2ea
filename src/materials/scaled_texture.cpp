#include "materials/scaled_texture.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace gradslc {
namespace {

class ScaledTexture final : public TextureMap {
 public:
  ScaledTexture(std::shared_ptr<const TextureMap> map, Rgb factor) : map_(std::move(map)), factor_(factor) {}

  Rgb eval(Vec2 uv) const override { return factor_ * map_->eval(uv); }
  Vec2 gradient(Vec2 uv) const override { return luminance(factor_) * map_->gradient(uv); }
  Rgb max_value() const override {
    const Rgb a = factor_ * map_->max_value(), b = factor_ * map_->min_value();  // factors may be negative
    return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)};
  }
  Rgb min_value() const override {
    const Rgb a = factor_ * map_->max_value(), b = factor_ * map_->min_value();
    return {std::min(a.r, b.r), std::min(a.g, b.g), std::min(a.b, b.b)};
  }
  std::size_t memory_bytes() const override { return sizeof(ScaledTexture) + map_->memory_bytes(); }

 private:
  std::shared_ptr<const TextureMap> map_;
  Rgb factor_;
};

}  // namespace

Texture scale_texture(const Texture& texture, Rgb factor) {
  if (!texture.map()) return Texture(factor * texture.eval({}));
  return Texture(std::make_shared<ScaledTexture>(texture.map(), factor));
}

}  // namespace gradslc
