#pragma once

#include <span>
#include <vector>

#include "integrators/gathering.h"
#include "lighttree/cut.h"
#include "lighttree/descent.h"

namespace gradslc {

struct ChosenVpl {
  std::uint32_t vpl;          ///< index into the tree's set
  float inverse_probability;  ///< of its being chosen
};

/// What selection has cost.
struct SelectionCost {
  std::uint64_t node_evaluations = 0, selections = 0, cut_nodes = 0;
  SelectionCost& operator+=(const SelectionCost& o) {
    node_evaluations += o.node_evaluations, selections += o.selections, cut_nodes += o.cut_nodes;
    return *this;
  }
};

/// Stochastic lightcuts' selection by descent (Yuksel 2019): one VPL below every node of a cut. With several receivers
/// the cut and the law are shared: weights are summed over the receivers, so that no VPL that lights one of them has
/// probability 0 (DESIGN 6). Keeps its memory between uses; one per thread.
class CutSelector {
 public:
  CutSelector(const LightTree& tree, const CutLimits& limits, float bound)
      : tree_(tree), limits_(limits), bound_(bound) {}

  /// The choice depends on `random`'s numbers for Use::descent alone. Valid until the next call.
  std::span<const ChosenVpl> select(std::span<const Receiver> receivers, const SampleStream& random);
  const SelectionCost& cost() const { return cost_; }
  /// Of the last selection alone.
  const SelectionCost& last_cost() const { return last_cost_; }

 private:
  const LightTree& tree_;
  CutLimits limits_;
  float bound_;
  LightCut cut_;
  std::vector<ChosenVpl> chosen_;
  SelectionCost cost_, last_cost_;
};

/// Tells a log, if there is one, of a selection shared by some receivers: each pixel has its share of the cost.
void log_selection(PathLog* log, const SelectionCost& cost, std::size_t receivers = 1);

/// Light from the chosen VPLs at x, a shadow ray for each that contributes.
VplLight gather_chosen(PathContext& context, const PathVertex& x, const LightTree& tree,
                       std::span<const ChosenVpl> chosen, float bound);

}  // namespace gradslc
