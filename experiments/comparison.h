#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/reference.h"
#include "experiments/render.h"
#include "experiments/results.h"

namespace gradslc {

/// All methods of one scene and repeat: what takes turns, and what is kept or repeated as a whole.
struct Comparison {
  const Experiment& experiment;
  const Scene& scene;
  std::string scene_name;
  RenderSettings settings;     ///< of this scene and repeat
  const Reference* reference;  ///< null: no errors are measured
  int repeat = 0;
};

/// One method's share of a comparison.
struct ComparedMethod {
  std::vector<ResultRow> rows;  ///< its curve points
  RenderResult result;
};

/// Runs the methods in turns; in the order of the experiment. `progress` gets the share that is done.
std::vector<ComparedMethod> run_comparison(const Comparison& comparison, const Makers& makers,
                                           const std::function<void(double)>& progress);

/// A row of results.csv for a curve point, without its errors.
ResultRow make_row(const CurvePoint& point, const Budget& budget);

}  // namespace gradslc
