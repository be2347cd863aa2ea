#pragma once

#include <span>

#include "vpl/vpl.h"

namespace gradslc {

/// Mean over VPLs of their surface density around them, divided by their number: 1/A, where A is the area that they
/// would cover evenly (1/length^2). Estimated from the k-th nearest neighbours of a fixed subset of them, k <= 16
/// (Loftsgaarden and Quesenberry 1965). 0 with fewer than two distinct positions.
double inverse_covered_area(std::span<const Vpl> vpls);

/// The default bound b = pi N / (kappa A): the connection strength of two white surfaces facing each other at the
/// radius whose disk holds kappa of N VPLs.
double automatic_bound(std::span<const Vpl> pilot, double kappa);

}  // namespace gradslc
