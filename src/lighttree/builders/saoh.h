#pragma once

#include "lighttree/light_tree.h"

namespace gradslc {

/// Splits top-down by surface area and orientation (saoh_topology.h), in two stages: runs of some hundred VPLs in
/// Morton order, and the runs as wholes above them (as Garanzha et al. 2011 do for ray tracing). Linear memory.
LightTree build_saoh(VplSet set);
double saoh_bytes(const VplCounts& counts);
double saoh_peak_bytes(const VplCounts& counts);

}  // namespace gradslc
