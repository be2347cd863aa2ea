#pragma once

#include "lighttree/light_tree.h"

namespace gradslc {

/// VPLs in Morton order of position, neighbours paired level by level (an odd one moves up alone): the report's
/// builder. Linear memory, depth ceil(log2 n).
LightTree build_pairs(VplSet set);

}  // namespace gradslc
