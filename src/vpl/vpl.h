#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/bulk_vector.h"
#include "core/octahedral.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "materials/lobes.h"

namespace gradslc {

/// A virtual point light (Keller 1997): the light that leaves vertex y of a light path through its connectable lobes,
/// or, at k = 0, the area light that the path starts on. 48 bytes.
struct Vpl {
  static constexpr std::uint32_t k_lambert = std::numeric_limits<std::uint32_t>::max();

  Point3 position;
  /// The particle's flux; where f_c(y) is Lambert, times the albedo pi f_c(y). The factor |wi.ns| / |wi.ng| of the
  /// shading normal is included (Veach 1997, section 5.3), and so is 1 / light_paths.
  Rgb flux;
  float max_pi_f = 0;                 ///< Lambert: largest channel of pi f_c(y); otherwise its bound's max(); > 0
  OctahedralNormal geometric_normal;  ///< on the side of shading_normal
  OctahedralNormal shading_normal;    ///< Lambert: on the side that reflects
  OctahedralNormal incoming;          ///< wi: towards the vertex before it; on an emitter the normal
  std::uint32_t surface = k_lambert;  ///< where f_c(y) is not Lambert: index into VplSet::surfaces
  std::uint16_t rounded_error = 0;    ///< upper half of a float that is not below SurfacePoint::error
  std::uint16_t vertex = 0;           ///< k: 0 on the emitter, 1 at the first surface

  bool is_lambert() const { return surface == k_lambert; }
  /// Bound of the position's rounding error, as in SurfacePoint, up to 1 % larger.
  float error() const { return std::bit_cast<float>(std::uint32_t{rounded_error} << 16); }
  /// `error` >= 0, finite.
  void set_error(float error) {
    rounded_error = static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(error) + 0xffffu) >> 16);
  }
};
static_assert(sizeof(Vpl) == 48);

/// What evaluating and bounding f_c(y) needs where it is not Lambert. 36 bytes.
struct VplSurface {
  std::uint32_t material = 0;
  Vec2 uv;
  OctahedralNormal tangent;  ///< s of the frame whose n is the VPL's shading_normal
  ValueBound bound;          ///< of pi f_c(y)
  bool behind = false;       ///< the path came from behind the surface's own shading normal
  bool transmits = false;    ///< f_c(y) scatters to both sides
};

/// All VPLs of one set of light paths, in the order of their paths.
struct VplSet {
  static constexpr std::size_t k_most = 0x7fffffff;  ///< VPLs: indices have 31 bits
  BulkVector<Vpl> vpls;
  BulkVector<VplSurface> surfaces;
  std::uint64_t rays = 0;  ///< traced to make it

  bool transmits(const Vpl& vpl) const { return !vpl.is_lambert() && surfaces[vpl.surface].transmits; }
};

/// How large a set is, or is expected to be.
struct VplCounts {
  double vpls = 0, surfaces = 0;
  double bytes() const { return vpls * sizeof(Vpl) + surfaces * sizeof(VplSurface); }
};

}  // namespace gradslc
