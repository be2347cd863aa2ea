#pragma once

#include <functional>
#include <span>

#include "experiments/method_run.h"

namespace gradslc {

/// Called for each curve point of the run with the given index; no method's clock runs meanwhile.
using PointReceiver = std::function<void(std::size_t run, PointImage point)>;

/// Brings all runs through their budgets in turns, so that a drift of the machine hits all alike: always the run that
/// has used the smallest share of its budget goes on, until it has used a fiftieth more, or for one pass where that is
/// longer. Among equals the one that comes first when counting from `first` (taken modulo the number of runs).
/// `progress` gets the mean share after every turn.
void take_turns(std::span<MethodRun> runs, std::size_t first, const PointReceiver& receive,
                const std::function<void(double)>& progress);

}  // namespace gradslc
