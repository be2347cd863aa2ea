#include "integrators/tile_gather.h"

namespace gradslc {

void TileGatherer::begin_tile(std::span<const Receiver> receivers, double u) {
  drawn_.clear();
  if (!receivers.empty()) {
    const TileLaw law(receivers,
                      {.defensive = parameters_.defensive, .cosine_floor = parameters_.cosine_floor, .bound = bound_});
    cost_.nodes += draw_candidates(tree_, law, parameters_.candidates, u, drawn_);
  }
  candidates_.assign(tree_.set, drawn_, parameters_.candidates);
  cost_.candidates += drawn_.size();
}

VplLight TileGatherer::gather(PathContext& context, const PathVertex& x, double u) {
  const GatherPoint point{x, context.lobes};
  const auto [least_k, most_k] = vertices_that_may_count(context, x);
  const CandidateReceiver receiver = make_candidate_receiver(point, least_k, most_k);
  candidates_.evaluate(receiver, bound_);
  cost_.evaluations += candidates_.size();
  candidates_.choose(parameters_.samples, u, choice_);
  VplLight light;
  for (const CandidateDraw& draw : choice_) {
    const Vpl& vpl = vpls_[candidates_.vpl(draw.candidate)];
    const Rgb contribution =
        receiver.lambert && vpl.is_lambert()
            ? candidates_.contribution(receiver, draw.candidate)
            : candidates_.weight(draw.candidate) * unshadowed_contribution(point, vpls_, vpl, bound_);
    if (is_black(contribution)) continue;
    const Rgb transmittance =
        connection_transmittance(context, connection_segment(point, vpl), connection_edges(x, vpl));
    if (is_black(transmittance)) continue;
    light.from(vpl) +=
        contribution * transmittance * static_cast<float>(draw.count / (parameters_.samples * draw.probability));
  }
  return light;
}

}  // namespace gradslc
