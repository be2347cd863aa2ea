#pragma once

#include <cstdint>

#include "core/parameters.h"
#include "materials/lobes.h"

namespace gradslc {

/// What is done about the singularity of VPL connections (DESIGN 4).
enum class Bounding : std::uint8_t {
  none,       ///< plain gathering: unbiased, fireflies
  clamp,      ///< connections bounded, the rest lost: biased
  compensate  ///< the rest is brought back by a ray: unbiased
};

/// How VPLs are made and connected to; the object `vpl` of every method that uses them.
struct VplParameters {
  std::int64_t light_paths = 1000;
  int max_bounces = 0;
  bool direct = false;
  int passes_per_set = 1;
  float connectable_roughness = 0.1f;
  Bounding bounding = Bounding::compensate;
  double bound = 0;
  double kappa = 14;

  LobeSelection lobes() const { return {true, true, connectable_roughness}; }
  /// max_bounces with its default resolved.
  int resolved_max_bounces(int max_depth) const { return max_bounces > 0 ? max_bounces : max_depth - 2; }
};

inline void describe(ParameterVisitor& v, VplParameters& p) {
  v.integer("light_paths", p.light_paths, {1, 1e9}, "paths", "light paths traced for one set of VPLs");
  v.integer("max_bounces", p.max_bounces, {0, 1000}, "vertices",
            "most surface vertices of a light path; 0: max_depth - 2; less truncates the estimand");
  v.boolean("direct", p.direct,
            "VPLs on area lights bring direct light to gather points, in place of next-event estimation");
  v.integer("passes_per_set", p.passes_per_set, {0, 1e9}, "passes",
            "passes that one VPL set lasts; 0: one set for the whole run, which converges to that set's image");
  v.real("connectable_roughness", p.connectable_roughness, {1e-3, 1}, "alpha",
         "lobes at least this rough are gathered by VPLs, sharper ones followed by paths");
  v.choice("bounding", p.bounding, {"none", "clamp", "compensate"},
           "near connections: plain, bounded (biased), or bounded and compensated by a ray");
  v.real("bound", p.bound, at_least(0), "1/length^2",
         "bound b of a connection's strength; 0: from the density of VPLs (kappa)");
  v.real("kappa", p.kappa, {1e-3, 1e6}, "VPLs", "b is reached at the radius that holds kappa VPLs on average");
}

}  // namespace gradslc
