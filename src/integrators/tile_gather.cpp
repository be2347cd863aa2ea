#include "integrators/tile_gather.h"

namespace gradslc {

void TileGatherer::begin_tile(std::span<const Receiver> receivers, double u) {
  drawn_.clear();
  tile_nodes_ = 0;
  if (!receivers.empty()) {
    const TileLaw law(receivers,
                      {.defensive = parameters_.defensive, .cosine_floor = parameters_.cosine_floor, .bound = bound_});
    tile_nodes_ = draw_candidates(tree_, law, parameters_.candidates, u, drawn_);
    cost_.nodes += tile_nodes_;
  }
  candidates_.assign(tree_.set, drawn_, parameters_.candidates);
  cost_.candidates += drawn_.size();
}

Rgb TileGatherer::gather(PathContext& context, const PathVertex& x, double u) {
  const GatherPoint point{x, context.lobes};
  const int most_k = context.settings.max_depth - x.edges - 1;
  const int least_k = context.settings.components.indirect ? 1 : most_k + 1;
  const CandidateReceiver receiver = make_candidate_receiver(point, least_k, most_k);
  candidates_.evaluate(receiver, bound_);
  cost_.evaluations += candidates_.size();
  candidates_.choose(parameters_.samples, u, choice_);
  if (context.log) context.log->add_selection(static_cast<float>(choice_.size()), 0);
  Rgb sum;
  for (const CandidateDraw& draw : choice_) {
    const Vpl& vpl = vpls_[candidates_.vpl(draw.candidate)];
    const Rgb contribution =
        receiver.lambert && vpl.is_lambert()
            ? candidates_.contribution(receiver, draw.candidate)
            : candidates_.weight(draw.candidate) * unshadowed_contribution(point, vpls_, vpl, bound_);
    if (is_black(contribution)) continue;
    const Rgb transmittance =
        connection_transmittance(context, connection_segment(point, vpl), connection_edges(x, vpl));
    const auto drawn = static_cast<float>(draw.count / (parameters_.samples * draw.probability));
    if (context.log) {
      const float candidate_weight = candidates_.weight(draw.candidate);
      log_connection(context, x, vpls_, candidates_.vpl(draw.candidate), bound_, contribution / candidate_weight,
                     transmittance, candidate_weight * drawn, candidate_weight);
    }
    if (is_black(transmittance)) continue;
    sum += contribution * transmittance * drawn;
  }
  return sum;
}

}  // namespace gradslc
