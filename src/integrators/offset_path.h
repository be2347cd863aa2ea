#pragma once

#include <optional>

#include "integrators/path.h"
#include "shifts/shift_result.h"

namespace gradslc {

/// How a base path left its last vertex: what a shift has to know of it.
struct Departure {
  /// Straight on (from the camera, past a crossing), or through one of the lobes.
  enum class Kind : std::uint8_t { straight, connectable, other, delta };
  Kind kind = Kind::straight;
  Point3 position;
  Vec3 wo, wi;  ///< local
  /// Of this direction by this kind of lobe: 1/sr, of delta lobes discrete; 0: no shift is known.
  float probability = 0;
  float eta = 1;  ///< where it is refracted: index below the surface over that above
};

/// `lobes`: all of them, split at the roughness by which vertices are connectable. `u` in [0,1) decides which kind of
/// lobe a direction is taken to be from that lobes of both kinds may have sampled: with the share that the kind has in
/// the density. So kinds have densities of their own, and each is shifted in its own way (docs/gradients.md).
Departure make_departure(const PathVertex& vertex, const BsdfSample& sample, const LobeSelection& lobes, float u);

/// Where the base path's last edge leads.
struct BaseEdge {
  const Departure& departure;  ///< of the vertex that it comes from
  const Ray& ray;
  const std::optional<SurfacePoint>& hit;
  const PathVertex* vertex = nullptr;  ///< at `hit`; null where the path ends
  int edges = 0;                       ///< of the path, with this one
  bool emits = false;                  ///< radiance comes from `hit`, or from outside the scene
};

/// The path that a shift makes of a base path, grown with it edge by edge. It keeps its throughput as its own pixel
/// would sample it, and the ratio of that density, times the shift's Jacobian, to the density of the base.
class OffsetPath {
 public:
  enum class State : std::uint8_t {
    separate,  ///< it has a vertex of its own
    arriving,  ///< it has come to the base's vertex by an edge of its own
    leaving,   ///< it has left the vertex where it arrived; the density of that direction is its own
    merged,    ///< nothing is its own but a constant throughput
    failed,    ///< there is no offset path from here on
  };

  void start(const Ray& camera_ray);

  // One call each for every step of the base path, in this order. `context`: counts the offsets' rays.
  /// Takes the offset's own edge where the base has taken `edge`.
  void follow(PathContext& context, const LobeSelection& lobes, const BaseEdge& edge);
  /// What an emitter at the edge's end brings the offset, weighted against next-event estimation; of the base the same
  /// without its throughput.
  Rgb emission(const PathContext& context, const BaseEdge& edge, Rgb base_emission) const;
  /// The base path goes on at the end of the edge. The offset fails where it has left the scene.
  void arrive();
  /// The base passes straight through its vertex or is scattered there, with probability `base_pass` of passing.
  void pass_or_scatter(const PathVertex& base, bool passes, float base_pass);
  /// Next-event estimation at the offset's own vertex; only where `separate`.
  Rgb next_event(PathContext& context) const;
  /// The same at the base's vertex, where `arriving`: what the emitter's radiance and the transmittance towards it, and
  /// the weight against sampled directions, are multiplied by.
  Rgb arriving_weight(const PathVertex& base, const Vec3& wi, const DirectSample& light) const;
  float arriving_mis(const PathVertex& base, const Vec3& wi, const DirectSample& light, const Passage& passage) const;
  /// The base is scattered into a direction. Separate offsets wait for its next edge.
  void leave(const PathVertex& base, const BsdfSample& sample);

  /// Adds one contribution of the base and the offset's, which is as a path of its own would bring it.
  void add(Rgb base, Rgb offset) { difference_ += offset_weight_ * offset - base_weight_ * base; }

  /// Adds what neither sense shifts: the difference of both pixels' own contributions.
  void add_unshifted(Rgb base) { difference_ += -1.0f * base; }

  State state() const { return state_; }
  Rgb throughput() const { return throughput_; }  ///< value over density, both the offset's own
  /// Offset minus base, weighted against the shift in the other sense: the sum of both senses' has the difference of
  /// both pixels' values as its mean.
  Rgb difference() const { return difference_; }
  std::optional<ShiftFailure> failure() const { return failure_; }

 private:
  void fail(ShiftFailure reason);
  void stop() { state_ = State::failed; }  // nothing more can come
  void scale(Rgb throughput, float ratio);
  void trace(PathContext& context, const LobeSelection& lobes, const BaseEdge& edge);
  void reconnect_to(PathContext& context, const LobeSelection& lobes, const BaseEdge& edge);
  bool copy_half_vector(const LobeSelection& lobes, const Departure& base);
  bool copy_delta(const Departure& base);
  bool take_direction(const Vec3& wi, float jacobian, const LobeSelection& lobes, const Departure& base);

  State state_ = State::separate;
  float base_weight_ = 0.5f, offset_weight_ = 0.5f;  // the latter times ratio_
  float ratio_ = 1;
  Rgb throughput_{1};
  Rgb difference_;
  Ray ray_;
  RayOrigin origin_;
  std::optional<SurfacePoint> hit_;
  std::optional<PathVertex> vertex_;  // while separate
  Vec3 wo_;                           // arriving: local at the base's vertex
  std::optional<ShiftFailure> failure_;
};

}  // namespace gradslc
