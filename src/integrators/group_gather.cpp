#include "integrators/group_gather.h"

#include <algorithm>
#include <cmath>

namespace gradslc {

GroupGatherer::GroupGatherer(const Scene& scene, const LightTree& tree, const GroupGatherSettings& settings)
    : scene_(scene),
      tree_(tree),
      settings_(settings),
      vpls_{scene.materials(), tree.set},
      selector_(tree, settings.cut, settings.gather.bound) {
  if (!settings_.tile) return;
  tile_.emplace(scene, tree, *settings_.tile, settings.lobes, settings.gather.bound, settings.reach);
  if (settings.reach > 0) behind_ = [this](auto&&... at) { return tile_->gather_behind(at...); };
}

void GroupGatherer::begin_tile(std::span<const Receiver> receivers, double u) {
  if (tile_) tile_->begin_tile(receivers, u);
}

void GroupGatherer::gather_without_vpls(GroupSample& sample, const GatherEffort& effort) {
  sample.seen =
      gradslc::gather_without_vpls(sample.context, *sample.prefix, settings_.gather, sample.radiance, effort, behind_);
}

void GroupGatherer::gather_alone(GroupSample& sample, const GatherEffort& effort) {
  if (!sample.prefix->gather) return;
  gather_without_vpls(sample, effort);
  const PathVertex& x = *sample.prefix->gather;
  VplLight light;
  if (tile_) {
    const double u = sample.context.random.get1_double(Use::candidate_choice);
    const TileLight gathered = tile_->gather(sample.context, x, effort.draws, u);
    light = gathered.light;
    const float scale = luminance(sample.prefix->throughput);
    sample.seen.draw_variance = gathered.draw_variance * scale * scale;
  } else {
    const Receiver receiver = make_receiver({x, settings_.lobes});
    const auto chosen = selector_.select({&receiver, 1}, sample.context.random);
    log_selection(sample.context.log, selector_.last_cost());
    light = gather_chosen(sample.context, x, tree_, chosen, settings_.gather.bound);
  }
  light.collect(sample.prefix->throughput, sample.radiance);
}

void GroupGatherer::gather_together(std::span<GroupSample> samples, const GatherEffort& effort,
                                    const SampleStream& random) {
  members_.clear();
  for (GroupSample& sample : samples) {
    if (!sample.prefix->gather) continue;
    gather_without_vpls(sample, effort);
    const PathVertex& x = *sample.prefix->gather;
    const VertexRange range = vertices_that_may_count(sample.context, x, sample.context.settings.max_depth);
    members_.push_back({&sample, make_candidate_receiver({x, settings_.lobes}, range.least, range.most), {}, {}});
  }
  candidates_ = tile_ ? &tile_->share() : nullptr;
  for (Members rest = members_; !rest.empty();) {
    const Members together = tile_ ? rest.first(gather_alike(rest)) : rest;
    if (tile_)
      choose_candidates(together, effort.draws, random);
    else
      choose_by_descent(together, random);
    for (const Draw& draw : draws_) connect(together, draw);
    rest = rest.subspan(together.size());
  }
  for (Member& member : members_) {
    GroupSample& sample = *member.sample;
    member.light.collect(sample.prefix->throughput, sample.radiance);
    const float scale = luminance(sample.prefix->throughput);
    sample.seen.draw_variance = member.scatter.variance_of_one(effort.draws) * scale * scale;
  }
}

void GroupGatherer::choose_by_descent(Members members, const SampleStream& random) {
  receivers_.clear();
  for (const Member& member : members) receivers_.push_back(member.receiver.receiver);
  draws_.clear();
  for (const ChosenVpl& chosen : selector_.select(receivers_, random))
    draws_.push_back({.vpl = chosen.vpl, .weight = chosen.inverse_probability});
  for (const Member& member : members) log_selection(member.sample->context.log, selector_.last_cost(), members.size());
}

std::size_t GroupGatherer::gather_alike(Members members) {
  const CandidateReceiver& first = members.front().receiver;
  const auto is_alike = [&](const Member& member) {
    constexpr float k_least_cosine = 0.9f, k_steepest = 0.5f;  // between normals; out of the first one's plane
    const CandidateReceiver& r = member.receiver;
    if (r.lambert != first.lambert || r.receiver.transmits != first.receiver.transmits) return false;
    const Vec3 d = r.receiver.position - first.receiver.position;
    const float height = dot(d, first.receiver.normal);
    return dot(as_vec(r.receiver.normal), first.receiver.normal) > k_least_cosine &&
           height * height <= k_steepest * k_steepest * length_squared(d);
  };
  return static_cast<std::size_t>(std::stable_partition(members.begin() + 1, members.end(), is_alike) -
                                  members.begin());
}

bool GroupGatherer::are_flat(Members members) {
  constexpr float k_thickness = 1e-4f, k_same_normal = 1e-12f;  // over the extent; squared difference
  const CandidateReceiver& first = members.front().receiver;
  float extent2 = 0, height = 0;
  for (const Member& member : members) {
    const CandidateReceiver& r = member.receiver;
    if (!r.lambert || r.receiver.transmits || r.least_k != first.least_k || r.most_k != first.most_k) return false;
    if (length_squared(as_vec(r.receiver.normal) - as_vec(first.receiver.normal)) > k_same_normal) return false;
    const Vec3 d = r.receiver.position - first.receiver.position;
    extent2 = std::max(extent2, length_squared(d));
    height = std::max(height, std::abs(dot(d, first.receiver.normal)));
  }
  return height * height <= k_thickness * k_thickness * extent2;
}

void GroupGatherer::find_law_receivers(Members members) {
  constexpr std::size_t k_corners = 4;
  law_receivers_.clear();
  if (members.size() <= k_corners || !are_flat(members)) {
    for (const Member& member : members) law_receivers_.push_back(member.receiver);
    return;
  }
  const CandidateReceiver& first = members.front().receiver;
  const Frame frame = frame_from_normal(first.receiver.normal);
  Vec2 lower, upper;
  Rgb diffuse;
  for (const Member& member : members) {
    const Vec3 d = frame.to_local(member.receiver.receiver.position - first.receiver.position);
    lower = {std::min(lower.x, d.x), std::min(lower.y, d.y)};
    upper = {std::max(upper.x, d.x), std::max(upper.y, d.y)};
    diffuse += member.receiver.diffuse / static_cast<float>(members.size());
  }
  for (const Vec2 corner : {lower, upper, Vec2{lower.x, upper.y}, Vec2{upper.x, lower.y}}) {
    CandidateReceiver& receiver = law_receivers_.emplace_back(first);
    receiver.diffuse = diffuse;
    receiver.receiver.position = first.receiver.position + frame.to_world({corner.x, corner.y, 0});
  }
}

void GroupGatherer::choose_candidates(Members members, int samples, const SampleStream& random) {
  find_law_receivers(members);
  tile_->count_evaluations(law_receivers_.size());
  candidates_->evaluate(law_receivers_, settings_.gather.bound);
  candidates_->choose(samples, random.get1_double(Use::candidate_choice), choice_);
  draws_.clear();
  for (const CandidateDraw& draw : choice_)
    draws_.push_back({.vpl = candidates_->vpl(draw.candidate),
                      .weight = static_cast<float>(draw.count / (samples * draw.probability)),
                      .count = draw.count,
                      .candidate = draw.candidate});
  for (const Member& member : members)
    if (PathLog* const log = member.sample->context.log) log->add_selection(static_cast<float>(choice_.size()), 0);
}

Rgb GroupGatherer::unshadowed(const Member& member, const Draw& draw) const {
  const Vpl& vpl = vpls_[draw.vpl];
  const float bound = settings_.gather.bound;
  if (!vpl_may_count(member.sample->context, member.x(), vpl)) return Rgb();
  if (draw.candidate && candidates_->simple() && member.receiver.lambert)
    return candidates_->contribution(member.receiver, *draw.candidate, bound);
  const Rgb contribution = unshadowed_contribution({member.x(), settings_.lobes}, vpls_, vpl, bound);
  return draw.candidate ? candidates_->weight(*draw.candidate) * contribution : contribution;
}

void GroupGatherer::connect(Members members, const Draw& draw) {
  const Vpl& vpl = vpls_[draw.vpl];
  const Normal3 normal = as_normal(vpl.geometric_normal.decode());
  connections_.clear(), segments_.clear(), max_crossings_.clear();
  for (std::size_t i = 0; i < members.size(); ++i) {
    Member& member = members[i];
    const Rgb contribution = unshadowed(member, draw);
    if (is_black(contribution)) {
      member.scatter.add(0, draw.count);
      continue;
    }
    const int edges = connection_edges(member.x(), vpl);
    connections_.push_back({i, contribution, edges});
    segments_.push_back(connection_segment({member.x(), settings_.lobes}, vpl, normal));
    max_crossings_.push_back(member.sample->context.settings.max_depth - edges);
  }
  passages_.resize(segments_.size());
  scene_.passages(segments_, max_crossings_, passages_);

  for (std::size_t i = 0; i < connections_.size(); ++i) {
    const auto& [index, contribution, edges] = connections_[i];
    Member& member = members[index];
    PathContext& context = member.sample->context;
    const Rgb transmittance = count_passage(context, passages_[i], edges).transmittance;
    const Rgb brought = contribution * transmittance * draw.weight;
    member.light.from(vpl) += brought;
    member.scatter.add(luminance(brought) / static_cast<float>(draw.count), draw.count);
    const bool learns = draw.candidate && tile_->parameters().learn_visibility;
    if (learns) candidates_->note_visibility(*draw.candidate, !is_black(transmittance));
    if (!context.log) continue;
    const std::optional<float> of_candidate =
        draw.candidate ? std::optional(candidates_->weight(*draw.candidate)) : std::nullopt;
    const float scale = of_candidate.value_or(1);
    log_connection(context, member.x(), vpls_, draw.vpl, settings_.gather.bound, contribution / scale, transmittance,
                   scale * draw.weight, of_candidate);
  }
}

}  // namespace gradslc
