#pragma once

#include "experiments/experiment.h"
#include "experiments/problems.h"

namespace gradslc {

/// Loads every scene of an experiment once and reports those that cannot be rendered: better now than when its turn
/// comes.
void check_scenes(const Experiment& experiment, Problems& problems);

}  // namespace gradslc
