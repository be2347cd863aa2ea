#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/ray.h"
#include "core/rgb.h"
#include "core/vec.h"

namespace gradslc {

/// A direction from a reference point towards an emitter.
struct DirectSample {
  Vec3 wi;                ///< unit, from the reference towards the emitter
  Rgb radiance;           ///< that arrives; its ratio to pdf_solid_angle is what counts where `delta`
  float pdf_solid_angle;  ///< 1/sr at the reference, > 0; for delta emitters the discrete probability
  Point3 position;        ///< on the emitter, offset off it towards the reference; meaningless where `infinite`
  bool infinite = false;  ///< the emitter is at infinity
  bool delta = false;     ///< no ray can hit the emitter by chance
};

/// A point of an area light.
struct EmittingPoint {
  Point3 position;
  Normal3 normal;   ///< unit, on the side that emits
  float error = 0;  ///< as in SurfacePoint
};

/// A particle's start.
struct EmissionSample {
  Ray ray;
  Rgb power;           ///< Le cos / (pdf_area pdf_solid_angle): what the particle carries if one path is traced
  bool delta = false;  ///< no ray can hit the emitter by chance
  std::optional<EmittingPoint> origin;  ///< on an area light; its emission is diffuse. nullopt: on none
};

/// A ball that holds the scene's surfaces.
struct BoundingSphere {
  Point3 centre;
  float radius = 0;
};

/// Where light from infinity enters the scene: through a disk as large as the scene, and more of its particles through
/// one as large as what the camera sees, so that a wide ground does not take them all.
struct EmissionExtent {
  static constexpr float k_focus_share = 0.75f;  ///< of the particles
  BoundingSphere scene;
  BoundingSphere focus;  ///< radius 0: none
};

/// An emitter that is not a surface of the scene: environment, directional, point and spot lights. Immutable.
class Light {
 public:
  virtual ~Light() = default;
  virtual std::string_view kind() const = 0;  ///< plug-in's name

  /// Flux that reaches the scene; of lights at infinity, what passes through the ball's great disk.
  virtual Rgb power(const BoundingSphere& scene) const = 0;
  /// nullopt where the light does not reach the reference. Probabilities do not include the choice of the light.
  virtual std::optional<DirectSample> sample_direct(Point3 reference, Vec2 u) const = 0;
  /// Only with power() > 0.
  virtual EmissionSample sample_emission(Vec2 u_point, Vec2 u_direction, const EmissionExtent& extent) const = 0;

  /// Whether rays that leave the scene can meet it: then radiance() and pdf_direct() are not 0 everywhere.
  virtual bool is_environment() const { return false; }
  /// All others are: no ray can hit them by chance.
  bool is_delta() const { return !is_environment(); }
  /// Radiance that comes from the unit direction `direction` (pointing away from the scene).
  virtual Rgb radiance(Vec3 /*direction*/) const { return Rgb(); }
  /// Density of sample_direct(), 1/sr; > 0 wherever radiance() is.
  virtual float pdf_direct(Vec3 /*direction*/) const { return 0; }
  virtual std::size_t memory_bytes() const { return 0; }
};

}  // namespace gradslc
