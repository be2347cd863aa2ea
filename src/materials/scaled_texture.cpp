#include "materials/scaled_texture.h"

#include <memory>
#include <utility>

namespace gradslc {
namespace {

class ScaledTexture final : public TextureMap {
 public:
  ScaledTexture(std::shared_ptr<const TextureMap> map, Rgb factor) : map_(std::move(map)), factor_(factor) {}

  Rgb eval(Vec2 uv) const override { return factor_ * map_->eval(uv); }
  Vec2 gradient(Vec2 uv) const override { return luminance(factor_) * map_->gradient(uv); }
  Rgb max_value() const override { return factor_ * map_->max_value(); }
  Rgb min_value() const override { return factor_ * map_->min_value(); }
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
