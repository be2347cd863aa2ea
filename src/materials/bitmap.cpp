#include "materials/bitmap.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace gradslc {
namespace {

constexpr int k_outside = -1;  // index of a texel beyond the border of an image that zero or one continues

Rgb min(Rgb a, Rgb b) { return {std::min(a.r, b.r), std::min(a.g, b.g), std::min(a.b, b.b)}; }
Rgb max(Rgb a, Rgb b) { return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)}; }
Rgb lerp(Rgb a, Rgb b, float t) { return a + (b - a) * t; }

/// A coordinate brought near [0,1]: into it, or for zero and one into [-1,2], which is far enough outside.
struct Wrapped {
  float t;
  float slope;  // dt by the coordinate: -1 where the image is mirrored
};
Wrapped wrap_coordinate(float t, Wrap wrap) {
  if (!std::isfinite(t)) return {0, 0};
  switch (wrap) {
    case Wrap::repeat:
      return {t - std::floor(t), 1};
    case Wrap::mirror: {
      const float in_period = t - 2 * std::floor(t / 2);
      return in_period > 1 ? Wrapped{2 - in_period, -1} : Wrapped{in_period, 1};
    }
    case Wrap::clamp:
      return {std::clamp(t, 0.0f, 1.0f), 1};
    case Wrap::zero:
    case Wrap::one:
      return {std::clamp(t, -1.0f, 2.0f), 1};
  }
  return {0, 0};
}

int wrap_index(int i, int size, Wrap wrap) {
  if (i >= 0 && i < size) return i;
  if (wrap == Wrap::repeat) return i < 0 ? i + size : i - size;
  if (wrap == Wrap::zero || wrap == Wrap::one) return k_outside;
  return std::clamp(i, 0, size - 1);
}

/// The two texels of an axis around a coordinate.
struct Neighbours {
  int first, second;
  float weight;  // of the second one
  float slope;   // of the weight by the coordinate
};
Neighbours find_neighbours(float coordinate, int size, Wrap wrap) {
  const Wrapped wrapped = wrap_coordinate(coordinate, wrap);
  const float x = wrapped.t * static_cast<float>(size) - 0.5f, below = std::floor(x);
  const int i = static_cast<int>(below);
  return {wrap_index(i, size, wrap), wrap_index(i + 1, size, wrap), x - below,
          wrapped.slope * static_cast<float>(size)};
}

int find_nearest(float coordinate, int size, Wrap wrap) {
  return wrap_index(static_cast<int>(std::floor(wrap_coordinate(coordinate, wrap).t * static_cast<float>(size))), size,
                    wrap);
}

/// Linear values of all that an integer can store, or of floats as they come.
template <class Value>
class Decoder {
 public:
  explicit Decoder(Encoding encoding) : table_(std::numeric_limits<Value>::max() + std::size_t{1}) {
    for (std::size_t i = 0; i < table_.size(); ++i)
      table_[i] = encoding.decode(static_cast<float>(i) / static_cast<float>(table_.size() - 1));
  }
  float operator()(Value stored) const { return table_[stored]; }
  std::size_t memory_bytes() const { return table_.size() * sizeof(float); }

 private:
  std::vector<float> table_;
};
template <>
class Decoder<float> {
 public:
  explicit Decoder(Encoding encoding) : encoding_(encoding) {}
  float operator()(float stored) const { return encoding_.decode(stored); }
  std::size_t memory_bytes() const { return 0; }

 private:
  Encoding encoding_;
};

template <class Value>
class Bitmap final : public TextureMap {
 public:
  Bitmap(std::shared_ptr<const Texels> texels, const std::vector<Value>& values, const BitmapOptions& options)
      : texels_(std::move(texels)), values_(values.data()), options_(options), decode_(options.encoding) {
    const int colours = texels_->channels >= 3 && options.channel < 0 ? 3 : 1;
    channels_ = {std::max(options.channel, 0), colours == 3 ? 1 : std::max(options.channel, 0),
                 colours == 3 ? 2 : std::max(options.channel, 0)};
    find_range();
  }

  Rgb eval(Vec2 uv) const override {
    const auto [u, v] = options_.to_uv.apply(uv);
    if (options_.nearest)
      return texel(find_nearest(u, width(), options_.wrap_u), find_nearest(v, height(), options_.wrap_v));
    const Neighbours x = find_neighbours(u, width(), options_.wrap_u);
    const Neighbours y = find_neighbours(v, height(), options_.wrap_v);
    const Rgb upper = lerp(texel(x.first, y.first), texel(x.second, y.first), x.weight);
    const Rgb lower = lerp(texel(x.first, y.second), texel(x.second, y.second), x.weight);
    return max(min_, min(max_, lerp(upper, lower, y.weight)));  // rounding may have left the range
  }

  Vec2 gradient(Vec2 uv) const override {
    if (options_.nearest) return {};
    const auto [u, v] = options_.to_uv.apply(uv);
    const Neighbours x = find_neighbours(u, width(), options_.wrap_u);
    const Neighbours y = find_neighbours(v, height(), options_.wrap_v);
    const float l00 = luminance(texel(x.first, y.first)), l10 = luminance(texel(x.second, y.first));
    const float l01 = luminance(texel(x.first, y.second)), l11 = luminance(texel(x.second, y.second));
    return options_.to_uv.chain({x.slope * ((1 - y.weight) * (l10 - l00) + y.weight * (l11 - l01)),
                                 y.slope * ((1 - x.weight) * (l01 - l00) + x.weight * (l11 - l10))});
  }

  Rgb max_value() const override { return max_; }
  Rgb min_value() const override { return min_; }
  std::size_t memory_bytes() const override { return texels_->memory_bytes() + decode_.memory_bytes(); }

 private:
  int width() const { return texels_->resolution.width; }
  int height() const { return texels_->resolution.height; }

  Rgb texel(int x, int y) const {
    if (x == k_outside) return Rgb(options_.wrap_u == Wrap::one ? 1.0f : 0.0f);
    if (y == k_outside) return Rgb(options_.wrap_v == Wrap::one ? 1.0f : 0.0f);
    const Value* const first =
        values_ + texels_->resolution.index({x, y}) * static_cast<std::size_t>(texels_->channels);
    return {decode_(first[channels_[0]]), decode_(first[channels_[1]]), decode_(first[channels_[2]])};
  }

  /// Decoding is monotonic: the range of the stored values decides.
  void find_range() {
    std::array<Value, 3> low{}, high{};
    for (std::size_t c = 0; c < 3; ++c) low[c] = high[c] = values_[channels_[c]];
    const auto step = static_cast<std::size_t>(texels_->channels);
    const Value* const end = values_ + texels_->resolution.pixels() * step;
    for (const Value* texel = values_; texel != end; texel += step)
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], texel[channels_[c]]);
        high[c] = std::max(high[c], texel[channels_[c]]);
      }
    min_ = {decode_(low[0]), decode_(low[1]), decode_(low[2])};
    max_ = {decode_(high[0]), decode_(high[1]), decode_(high[2])};
    for (const Wrap wrap : {options_.wrap_u, options_.wrap_v}) {
      if (wrap == Wrap::zero) extend_range(Rgb(0));
      if (wrap == Wrap::one) extend_range(Rgb(1));
    }
  }
  void extend_range(Rgb value) {
    min_ = min(min_, value);
    max_ = max(max_, value);
  }

  std::shared_ptr<const Texels> texels_;
  const Value* values_;
  BitmapOptions options_;
  Decoder<Value> decode_;
  std::array<int, 3> channels_{};  // that are red, green and blue
  Rgb min_, max_;
};

}  // namespace

float Encoding::decode(float stored) const {
  if (gamma == 1) return stored;
  if (gamma == k_srgb) return srgb_to_linear(stored);
  return std::pow(std::max(stored, 0.0f), gamma);
}

std::shared_ptr<const TextureMap> make_bitmap(std::shared_ptr<const Texels> texels, const BitmapOptions& options) {
  assert(texels->resolution.pixels() > 0 && options.channel < texels->channels);
  return std::visit(
      [&](const auto& values) -> std::shared_ptr<const TextureMap> {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        return std::make_shared<Bitmap<Value>>(texels, values, options);
      },
      texels->values);
}

}  // namespace gradslc
