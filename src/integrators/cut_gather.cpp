#include "integrators/cut_gather.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gradslc {

std::span<const ChosenVpl> CutSelector::select(std::span<const Receiver> receivers, const SampleStream& random) {
  chosen_.clear();
  find_cut(tree_, receivers, bound_, limits_, cut_);
  last_cost_ = {
      .node_evaluations = cut_.evaluated.size() * receivers.size(), .selections = 1, .cut_nodes = cut_.entries.size()};

  // One double with 64 random bits, rotated by the golden ratio from node to node: stratified across the cut, uniform
  // for each node.
  constexpr double k_below_one = 1 - 0x1p-53;
  const double start = random.get1_double(Use::descent, 0) + random.get1_double(Use::descent, 1) * 0x1p-32;
  double rotation = 0;
  for (const CutEntry& entry : cut_.entries) {
    const double u = start + rotation;
    rotation += 1 / std::numbers::phi;
    const auto sample = descend(tree_, cut_, entry, receivers, bound_, std::min(u - std::floor(u), k_below_one),
                                last_cost_.node_evaluations);
    if (sample) chosen_.push_back({sample->vpl, static_cast<float>(1 / sample->probability)});
  }
  cost_ += last_cost_;
  return chosen_;
}

void log_selection(PathLog* log, const SelectionCost& cost, std::size_t receivers) {
  if (!log) return;
  log->add_selection(static_cast<float>(cost.cut_nodes),
                     static_cast<float>(cost.node_evaluations) / static_cast<float>(receivers));
}

VplLight gather_chosen(PathContext& context, const PathVertex& x, const LightTree& tree,
                       std::span<const ChosenVpl> chosen, float bound) {
  const GatherPoint point{x, context.lobes};
  const VplView vpls{context.scene.materials(), tree.set};
  VplLight light;
  for (const ChosenVpl& choice : chosen) {
    const Vpl& vpl = vpls[choice.vpl];
    if (!vpl_may_count(context, x, vpl)) continue;
    const Rgb contribution = unshadowed_contribution(point, vpls, vpl, bound);
    if (is_black(contribution)) continue;
    const Rgb transmittance =
        connection_transmittance(context, connection_segment(point, vpl), connection_edges(x, vpl));
    light.from(vpl) += contribution * transmittance * choice.inverse_probability;
    if (context.log)
      log_connection(context, x, vpls, choice.vpl, bound, contribution, transmittance, choice.inverse_probability);
  }
  return light;
}

}  // namespace gradslc
