#include "integrators/tile_gather.h"

#include <algorithm>
#include <array>

namespace gradslc {

void TileGatherer::begin_tile(std::span<const Receiver> receivers, double u) {
  drawn_.clear();
  tile_nodes_ = 0;
  gathers_ = 0;
  if (!receivers.empty()) {
    const TileLaw law(receivers, {.defensive = parameters_.defensive,
                                  .cosine_floor = parameters_.cosine_floor,
                                  .power_share = parameters_.power_share,
                                  .bound = bound_,
                                  .reach = reach_});
    tile_nodes_ = draw_candidates(tree_, law, parameters_.candidates, u, drawn_);
    cost_.nodes += tile_nodes_;
  }
  candidates_.assign(tree_.set, drawn_, parameters_.candidates);
  calibrate(receivers);
  cost_.candidates += drawn_.size();
}

void TileGatherer::calibrate(std::span<const Receiver> receivers) {
  constexpr std::size_t k_points = 4;
  if (receivers.empty()) return;
  std::array<Point3, k_points> points;
  for (std::size_t i = 0; i < k_points; ++i)  // along a diagonal of the tile
    points[i] = receivers[(2 * i + 1) * (receivers.size() - 1) / (2 * k_points)].position;
  candidates_.calibrate(vpls_, lobes_, points);
}

CandidateSet& TileGatherer::share() {
  if (parameters_.learn_visibility) candidates_.learn_visibility();
  return candidates_;
}

TileLight TileGatherer::gather(PathContext& context, const PathVertex& x, int draws, double u) {
  if (parameters_.learn_visibility && gathers_++ % k_gathers_between_lessons == 0) candidates_.learn_visibility();
  const int max_edges = context.settings.max_depth;
  const VertexRange range = vertices_that_may_count(context, x, max_edges);
  const CandidateReceiver receiver = make_candidate_receiver({x, context.lobes}, range.least, range.most);
  candidates_.evaluate(receiver, bound_);
  cost_.evaluations += candidates_.size();
  return sum_draws(context, x, receiver, nullptr, max_edges, draws, u);
}

Rgb TileGatherer::gather_behind(PathContext& context, const PathVertex& y, const Compensation& left_over,
                                int max_edges) {
  VertexRange range = vertices_that_may_count(context, y, max_edges);
  range.least = std::max(range.least, 1);  // emitters are left to next-event estimation
  const auto index = static_cast<std::uint32_t>(y.edges);
  const CandidateSubset subset = candidates_.random_subset(context.random.get1(Use::candidate_subset, index));
  const CandidateReceiver receiver = make_candidate_receiver({y, context.lobes}, range.least, range.most);
  candidates_.evaluate(receiver, bound_, subset);
  cost_.evaluations += candidates_.size() / subset.stride;
  const double u = context.random.get1_double(Use::candidate_choice, index);
  return sum_draws(context, y, receiver, &left_over, max_edges, 1, u).light.vpl;
}

TileLight TileGatherer::sum_draws(PathContext& context, const PathVertex& x, const CandidateReceiver& receiver,
                                  const Compensation* left_over, int max_edges, int samples, double u) {
  const GatherPoint point{x, context.lobes};
  candidates_.choose(samples, u, choice_);
  if (context.log) context.log->add_selection(static_cast<float>(choice_.size()), 0);
  VplLight light;
  DrawScatter scatter;
  for (const CandidateDraw& draw : choice_) {
    const Vpl& vpl = vpls_[candidates_.vpl(draw.candidate)];
    const Rgb contribution =
        receiver.lambert && vpl.is_lambert()
            ? candidates_.contribution(receiver, draw.candidate)
            : candidates_.weight(draw.candidate) * unshadowed_contribution(point, vpls_, vpl, bound_);
    if (is_black(contribution)) {
      scatter.add(0, draw.count);
      continue;
    }
    const Ray segment = connection_segment(point, vpl, candidates_.geometric_normal(draw.candidate));
    const Rgb transmittance = connect(context, segment, connection_edges(x, vpl), max_edges).transmittance;
    auto drawn = static_cast<float>(draw.count / (samples * draw.probability));
    if (left_over) {
      const Vec3 wi = x.to_local(normalize(vpl.position - x.point.position));
      drawn *= left_over->weight(x.bsdf.eval(x.wo, wi, context.lobes.only_connectable()));
    }
    if (context.log) {
      const float candidate_weight = candidates_.weight(draw.candidate);
      log_connection(context, x, vpls_, candidates_.vpl(draw.candidate), bound_, contribution / candidate_weight,
                     transmittance, candidate_weight * drawn, candidate_weight);
    }
    if (!left_over && parameters_.learn_visibility)
      candidates_.note_visibility(draw.candidate, !is_black(transmittance));
    const Rgb brought = contribution * transmittance * drawn;
    light.from(vpl) += brought;
    scatter.add(luminance(brought) / static_cast<float>(draw.count), draw.count);
  }
  return {light, scatter.variance_of_one(samples)};
}

}  // namespace gradslc
