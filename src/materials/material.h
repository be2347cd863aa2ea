#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/frame.h"
#include "materials/bsdf.h"
#include "materials/property_reader.h"
#include "materials/texture.h"

namespace gradslc {

/// What a material may ask about the surface at a point.
struct MaterialPoint {
  Vec2 uv;
  Vec3 dp_du, dp_dv;  ///< zero where the uvs are degenerate, or nobody needs_derivatives()
};

/// How a surface scatters at a point: a BSDF in a frame of its own.
struct Shading {
  Frame frame;  ///< its n on the geometric normal's side, but where two-sided materials turn it to the other one
  Bsdf bsdf;
};

/// What a scene file says of a surface. Immutable; all queries may run concurrently.
class Material {
 public:
  virtual ~Material() = default;

  /// Adds its lobes to shading.bsdf and turns shading.frame, the surface's shading frame, where it bends normals or is
  /// two-sided. `known`: unit, world space, the direction in which the path has come to the point.
  virtual void shade(const MaterialPoint& point, const Vec3& known, Shading& shading) const = 0;
  /// Whether a lobe outside the connectable ones exists anywhere on it. What passes straight through is no lobe.
  virtual bool has_other_lobes(const LobeSelection& lobes) const = 0;
  /// Upper bound of pi f of the connectable lobes anywhere on it for any directions, largest channel; finite.
  virtual float max_connectable_pi_f(const LobeSelection& lobes) const = 0;
  /// Most lobes that shade() adds.
  virtual int max_lobes() const { return 1; }
  /// Whether shade() needs a frame whose s follows dp/du, or the derivatives themselves.
  virtual bool needs_derivatives() const { return false; }
  /// Whether shade() may turn the frame in another way than to the other side.
  virtual bool bends_normals() const { return false; }
  /// Whether light may pass to the other side.
  virtual bool transmits() const { return false; }
  /// Whether light may pass straight through anywhere on it (Bsdf::straight_transmittance()).
  virtual bool crosses() const { return false; }
  /// Whether shade() turns the frame to the other side where `known` comes from there.
  virtual bool turns_frame() const { return false; }
  /// Textures that it and what is nested in it refer to; may hold constants.
  virtual std::vector<Texture> textures() const { return {}; }
};

/// How a material is called.
struct MaterialName {
  std::string id;    ///< in the scene file; may be empty
  std::string kind;  ///< its plug-ins, outermost first: "twosided diffuse"; may be empty
};

struct BsdfEntry {
  const char* name;  ///< as in scene files
  const char* meaning;
  MaterialPtr (*make)(PropertyReader& properties);
};
/// The only list of BSDF plug-ins.
std::span<const BsdfEntry> bsdf_registry();

}  // namespace gradslc
