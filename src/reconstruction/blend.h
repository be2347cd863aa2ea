#pragma once

#include "core/image.h"

namespace gradslc {

/// from + t (towards - from), t in [0,1] pixel by pixel: the one that over (2 radius + 1)^2 pixels comes nearest to
/// `judge`, an unbiased estimate with noise of its own (the same linear model, by halves of the samples, that Rousselle
/// et al. 2012, "Adaptive rendering with non-local means filtering", estimate errors by). Where little can be told, and
/// so as a filter should in a few samples, t is near 1. Differences count relative to the pixels' size.
RgbImage blend(const RgbImage& from, const RgbImage& towards, const RgbImage& judge, int radius);

}  // namespace gradslc
