#pragma once

namespace gradslc {

/// What a method is expected to hold in memory beside the scene and what it keeps per pixel.
struct MemoryPlan {
  double light_paths = 0, vpls = 0;  ///< of one VPL set; 0: the method has none
  double resident_bytes = 0;         ///< while it renders
  double peak_bytes = 0;             ///< while it makes a set, >= resident_bytes; in proportion to light_paths
};

}  // namespace gradslc
