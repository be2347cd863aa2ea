#pragma once

#include <cstdint>

#include "samplers/sampler.h"
#include "scene/scene.h"
#include "vpl/vpl.h"

namespace gradslc {

struct LightTracingSettings {
  std::int64_t light_paths = 1;
  int max_bounces = 1;       ///< most surface vertices of a path; at most 0: none
  bool on_emitters = false;  ///< paths that start on an area light leave a VPL there, too
  LobeSelection lobes;       ///< VPLs sit where its connectable lobes are
  SamplerKind sampler = SamplerKind::sobol;
  std::uint64_t seed = 1;
  std::uint64_t set = 0;  ///< path i uses sample set * light_paths + i of the seed's sequence
};

/// Traces light paths from the emitters and leaves a VPL at every vertex k >= 1 that has a connectable lobe, and, if
/// asked for, at k = 0. Emitters are chosen in proportion to power; Russian roulette by throughput from the second
/// vertex on. The same bits for any number of threads. A scene without emitters gives no VPLs.
VplSet trace_vpls(const Scene& scene, const LightTracingSettings& settings);

}  // namespace gradslc
