#pragma once

#include <cstdint>

#include "core/bounds.h"
#include "vpl/vpl.h"

namespace gradslc {

/// Directions within an angle of an axis.
struct Cone {
  Vec3 axis{0, 0, 1};  ///< unit
  float cosine = 1;    ///< of the half angle, in [-1, 1]; -1: all directions

  float sine() const { return std::sqrt(std::max(0.0f, 1 - cosine * cosine)); }
};

/// A cone that holds others: around their mean axis, opened to the widest. Half angles add by cosines and sines; what
/// exceeds pi is the whole sphere. First add_axis() for all, then close_axes(), then open_to() for all.
class ConeUnion {
 public:
  void add_axis(const Cone& cone);
  void close_axes();
  void open_to(const Cone& cone);
  Cone result() const;

 private:
  Vec3 sum_;
  Cone result_;
  bool whole_ = false;
};

/// What the light tree knows of some VPLs together.
struct LightCluster {
  Bounds3 box;
  float flux = 0;         ///< sum of upper bounds of pi f_c(y) flux but for glossy lobes, luminance
  float capped_flux = 0;  ///< sum over all lobes of the flux / max pi f_c(y): times b / pi^2, a bound where bounded
  /// Towards a direction at angle a to the axis, the VPLs' cosines are at most cos(max(0, a - h)), h the half angle: it
  /// holds the geometric normals, and more where shading normals differ or light leaves on both sides.
  Cone normals;
  GlossBound gloss;  ///< of light through microfacet lobes, luminance, towards a direction at an angle to ...
  Cone mirrored;     ///< ... the nearest of these directions
};

LightCluster make_cluster(const VplSet& set, const Vpl& vpl);

/// A few ulp of 1: cones must still hold their directions after rounding.
constexpr float k_cone_rounding = 4e-7f;

}  // namespace gradslc
