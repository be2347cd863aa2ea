#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "core/rgb.h"
#include "core/vec.h"

namespace gradslc {

/// A quantity that varies over a surface's uv coordinates.
class TextureMap {
 public:
  virtual ~TextureMap() = default;
  /// Linear RGB.
  virtual Rgb eval(Vec2 uv) const = 0;
  /// Derivatives of the luminance by u and v: the slope of a bump map.
  virtual Vec2 gradient(Vec2 uv) const = 0;
  /// Per channel, never below or above eval() anywhere.
  virtual Rgb max_value() const = 0;
  virtual Rgb min_value() const = 0;
  virtual std::size_t memory_bytes() const = 0;
};

/// A reflectance or other quantity of a material: a constant or a map, linear RGB.
class Texture {
 public:
  Texture() = default;
  explicit Texture(Rgb constant) : constant_(constant) {}
  explicit Texture(std::shared_ptr<const TextureMap> map) : map_(std::move(map)) {}

  Rgb eval(Vec2 uv) const { return map_ ? map_->eval(uv) : constant_; }
  Vec2 gradient(Vec2 uv) const { return map_ ? map_->gradient(uv) : Vec2(); }
  Rgb max_value() const { return map_ ? map_->max_value() : constant_; }
  Rgb min_value() const { return map_ ? map_->min_value() : constant_; }
  /// Null for constants.
  const std::shared_ptr<const TextureMap>& map() const { return map_; }

 private:
  Rgb constant_;
  std::shared_ptr<const TextureMap> map_;
};

}  // namespace gradslc
