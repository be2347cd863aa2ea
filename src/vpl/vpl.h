#pragma once

#include <cstdint>
#include <vector>

#include "core/octahedral.h"
#include "core/rgb.h"
#include "core/vec.h"

namespace gradslc {

/// A virtual point light (Keller 1997): the light that leaves vertex y of a light path through its connectable lobe.
/// 48 bytes.
struct Vpl {
  Point3 position;
  /// pi times the flux that the particle brings times f_c(y), which is Lambert: flux times albedo. The factor
  /// |wi.ns| / |wi.ng| of the shading normal is included (Veach 1997, section 5.3), and so is 1 / light_paths.
  Rgb reflected_flux;
  float max_albedo = 0;               ///< largest channel of pi f_c(y), > 0
  OctahedralNormal geometric_normal;  ///< on the side of shading_normal
  OctahedralNormal shading_normal;    ///< on the side that reflects
  OctahedralNormal incoming;          ///< wi: towards the vertex before it
  float error = 0;                    ///< bound of the position's rounding error, as in SurfacePoint
  std::uint32_t vertex = 0;           ///< k: 0 on the emitter, 1 at the first surface
};
static_assert(sizeof(Vpl) == 48);

/// All VPLs of one set of light paths, in the order of their paths.
struct VplSet {
  std::vector<Vpl> vpls;
  std::uint64_t rays = 0;  ///< traced to make it
};

}  // namespace gradslc
