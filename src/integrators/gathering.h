#pragma once

#include "integrators/camera_prefix.h"
#include "vpl/connection.h"
#include "vpl/vpl_parameters.h"

namespace gradslc {

/// What gathering needs to know beside the path (DESIGN 4).
struct GatherSettings {
  float bound = k_infinity;  ///< b of VPL connections; infinite: plain gathering
  bool compensate = false;   ///< what bounding takes is brought back by the ray
  int max_bounces = 1;       ///< most vertices on the light's side
  bool scene_has_other_lobes = false;
  float max_pi_f = 1;  ///< upper bound of pi f_c anywhere
};
GatherSettings make_gather_settings(const Scene& scene, const VplParameters& parameters, float bound, int max_depth);

/// D = p + 1 + k of the paths that connect x with a VPL, without the crossings between them.
inline int connection_edges(const PathVertex& x, const Vpl& y) { return x.edges + 1 + static_cast<int>(y.vertex); }
/// Whether they can count, whatever the connection crosses.
inline bool vpl_may_count(const PathContext& context, const PathVertex& x, const Vpl& y) {
  return connection_may_count(context, connection_edges(x, y), context.settings.max_depth);
}

/// Everything at the gather vertex except light from VPLs: next-event estimation through f_c(x), and the ray through
/// f_c(x) that brings emitters (weighted against next-event estimation), f_s(y) with weight 1 and f_c(y) with what
/// bounding has taken. `mean_rays` > 0 of these rays are sent on average: their number is rounded at random, and what
/// they bring divided by the mean. Returns the luminance that they brought, all parts together.
float gather_without_vpls(PathContext& context, const CameraPrefix& prefix, const GatherSettings& gather,
                          PartValues& radiance, float mean_rays = 1);

/// Tells the context's log of a connection whose shadow ray was traced: x gets unshadowed * transmittance * weight.
void log_connection(const PathContext& context, const PathVertex& x, const VplView& vpls, std::uint32_t vpl,
                    float bound, Rgb unshadowed, Rgb transmittance, float weight,
                    std::optional<float> candidate_weight = std::nullopt);

}  // namespace gradslc
