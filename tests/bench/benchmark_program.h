#pragma once

#include <string>
#include <vector>

#include "experiments/method_plan.h"

namespace gradslc {

/// The method `integrator` with "key=value" parameters. Throws Error with the first problem.
MethodPlan read_method_options(const std::string& integrator, const std::vector<std::string>& overrides);

/// A program's main(): calls `run` in the environment that gradslc sets; an Error goes to stderr and makes 1.
int run_benchmark(int (*run)(int argc, char** argv), int argc, char** argv);

}  // namespace gradslc
