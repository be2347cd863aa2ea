#pragma once

#include <memory>

#include "materials/texels.h"
#include "materials/texture.h"
#include "materials/uv_transform.h"

namespace gradslc {

/// What continues an image beyond [0,1].
enum class Wrap : std::uint8_t { repeat, mirror, clamp, zero, one };

/// How stored values become linear ones.
struct Encoding {
  static constexpr float k_srgb = -1;
  float gamma = k_srgb;  ///< > 0: linear value = stored value ^ gamma, stored values below 0 as 0; k_srgb: sRGB's curve

  float decode(float stored) const;
};

struct BitmapOptions {
  UvTransform to_uv;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;  ///< the texel around the point instead of bilinear interpolation
  Encoding encoding;
  int channel = -1;  ///< the one channel that serves as grey; -1: all colours, without alpha
};

/// An image as a texture. u grows to the right and v *downwards*: (0,0) is the upper left corner of the image, as in
/// Mitsuba 0.6 and 3, whose OBJ loaders flip v. Texel (i,j) has its centre at ((i+0.5)/width, (j+0.5)/height).
/// gradient() is the derivative of the bilinear interpolant; zero for `nearest`. uvs that are not finite count as 0.
/// memory_bytes() counts the texels, also where other textures share them.
std::shared_ptr<const TextureMap> make_bitmap(std::shared_ptr<const Texels> texels, const BitmapOptions& options);

}  // namespace gradslc
