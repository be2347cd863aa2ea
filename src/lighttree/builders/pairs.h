#pragma once

#include "lighttree/light_tree.h"

namespace gradslc {

/// VPLs in Morton order of position, neighbours paired level by level, three levels to a node: the report's builder.
/// Linear memory, depth ceil(log8 n).
LightTree build_pairs(VplSet set);
double pairs_bytes(const VplCounts& counts);
double pairs_peak_bytes(const VplCounts& counts);

}  // namespace gradslc
