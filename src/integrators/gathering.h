#pragma once

#include <functional>

#include "integrators/camera_prefix.h"
#include "integrators/gather_effort.h"
#include "vpl/connection.h"
#include "vpl/vpl_parameters.h"

namespace gradslc {

/// What gathering needs to know beside the path (DESIGN 4).
struct GatherSettings {
  float bound = k_infinity;  ///< b of VPL connections; infinite: plain gathering
  bool compensate = false;   ///< what bounding takes is brought back by the ray
  int max_bounces = 1;       ///< most vertices on the light's side
  bool scene_has_other_lobes = false;
  float max_pi_f = 1;  ///< upper bound of pi f_c anywhere, emission included where it has VPLs
  EmitterChoice next_event = EmitterChoice::all;  ///< at x; light from all others comes from VPLs on them
};
GatherSettings make_gather_settings(const Scene& scene, const VplParameters& parameters, float bound, int max_depth);

/// How far the vertices at which bounding leaves something over can lie from the gather vertex: as many steps as paths
/// have, each no longer than K can exceed b; nor farther than the scene is wide.
float reach_of_vertices(const Scene& scene, const GatherSettings& gather, int max_depth);

/// D = p + 1 + k of the paths that connect x with a VPL, without the crossings between them.
inline int connection_edges(const PathVertex& x, const Vpl& y) { return x.edges + 1 + static_cast<int>(y.vertex); }
/// Whether they can count, whatever the connection crosses.
inline bool vpl_may_count(const PathContext& context, const PathVertex& x, const Vpl& y) {
  return connection_may_count(context, connection_edges(x, y), context.settings.max_depth);
}

/// The vertices k of light paths whose VPLs may count at x over paths of at most `max_edges`; none where least > most.
struct VertexRange {
  int least, most;
};
inline VertexRange vertices_that_may_count(const PathContext& context, const PathVertex& x, int max_edges) {
  const int nearest = x.edges + 1;
  VertexRange range{0, max_edges - nearest};
  const auto counts = [&](int k) { return connection_may_count(context, nearest + k, max_edges); };
  while (range.least <= range.most && !counts(range.least)) ++range.least;
  while (range.least <= range.most && !counts(range.most)) --range.most;
  return range;
}

/// Light from VPLs at x: of those on emitters, which is direct light, and of all others.
struct VplLight {
  Rgb direct, vpl;

  Rgb& from(const Vpl& y) { return y.vertex == 0 ? direct : vpl; }
  Rgb total() const { return direct + vpl; }
  void collect(Rgb throughput, PartValues& radiance) const {
    radiance[Part::direct] += throughput * direct;
    radiance[Part::vpl] += throughput * vpl;
  }
};

/// Light from VPLs at y, a vertex behind a ray, over paths of at most `max_edges`, times what bounding has left over of
/// the connection to y: an estimate that stands for the path's going on from y through f_c(y).
using VertexGather =
    std::function<Rgb(PathContext& context, const PathVertex& y, const Compensation& left_over, int max_edges)>;

/// Everything at the gather vertex except light from VPLs: next-event estimation through f_c(x), and rays through
/// f_c(x) that bring emitters (weighted against next-event estimation, or with what bounding has taken from VPLs on
/// them), f_s(y) with weight 1 and f_c(y) with what bounding has taken. `effort` says how many of each: what they bring
/// is divided by their number, that of rays, rounded at random, by its mean. Behind the rays `vertices`, if there is
/// one, gathers; otherwise paths go on. Tells what each kind brought; `total` and `draw_variance` are left 0.
EffortAllocation::Sample gather_without_vpls(PathContext& context, const CameraPrefix& prefix,
                                             const GatherSettings& gather, PartValues& radiance,
                                             const GatherEffort& effort = {}, const VertexGather& vertices = {});

/// Tells the context's log of a connection whose shadow ray was traced: x gets unshadowed * transmittance * weight.
void log_connection(const PathContext& context, const PathVertex& x, const VplView& vpls, std::uint32_t vpl,
                    float bound, Rgb unshadowed, Rgb transmittance, float weight,
                    std::optional<float> candidate_weight = std::nullopt);

}  // namespace gradslc
