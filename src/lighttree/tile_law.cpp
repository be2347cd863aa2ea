#include "lighttree/tile_law.h"

#include <algorithm>
#include <vector>

#include "lighttree/cluster_kernel.h"

namespace gradslc {
namespace {

/// What a node's lanes say that does not depend on the receiver.
struct NodeLanes {
  Float8 centre[3], radius2, radius, flux, cap, axis[3], cosine, sine;
  Float8 narrowness;  ///< 1 where all normals are one, 0 from half a sphere on

  NodeLanes(const LightNode& node, float bound) {
    radius2 = 0;
    for (int i = 0; i < 3; ++i) {
      const Float8 lower = load_aligned(node.lower[i]), half = 0.5f * (load_aligned(node.upper[i]) - lower);
      centre[i] = lower + half;
      radius2 += half * half;
      axis[i] = load_aligned(node.axis[i]);
    }
    flux = load_aligned(node.flux), cap = load_aligned(node.capped_flux) * bound;
    radius = stdx::sqrt(radius2);
    cosine = load_aligned(node.cosine), sine = load_aligned(node.sine);
    narrowness = stdx::max(cosine, Float8(0));
  }
};

/// Flux towards a point at `to` from the boxes' centres.
Float8 flux_towards(const NodeLanes& lanes, const GlossyLanes* gloss, const Float8 (&to)[3], Float8 distance2) {
  if (!gloss) return lanes.flux;
  const Float8 axis[3] = {load_aligned(gloss->axis[0]), load_aligned(gloss->axis[1]), load_aligned(gloss->axis[2])};
  const Float8 cosine =
      lane_cone_cosine(to, distance2, lanes.radius2, axis, load_aligned(gloss->cosine), load_aligned(gloss->sine));
  return lanes.flux + bounded_gloss<Float8>(load_aligned(gloss->peak), load_aligned(gloss->tail),
                                            load_aligned(gloss->alpha2), cosine);
}

/// Importance to one receiver: as if a node's light came from its box's centre, at no less than the box's own size,
/// with cosines that grow with the box and the cone.
Float8 importance(const NodeLanes& lanes, const GlossyLanes* gloss, const Receiver& r, float floor) {
  const Float8 to_receiver[3] = {r.position.x - lanes.centre[0], r.position.y - lanes.centre[1],
                                 r.position.z - lanes.centre[2]};
  const Float8 normal[3] = {r.normal.x, r.normal.y, r.normal.z};
  const Float8 centre_distance2 = lane_dot(to_receiver, to_receiver), along_axis = lane_dot(to_receiver, lanes.axis);
  const Float8 along_normal = -lane_dot(to_receiver, normal);
  const Float8 distance2 = centre_distance2 + lanes.radius2;
  const Float8 per_distance = 1 / stdx::sqrt(distance2);
  const Float8 cos_receiver =
      stdx::max(stdx::min((along_normal + lanes.radius) * per_distance, Float8(1)), Float8(floor));
  const Float8 spread = 1 + (along_axis * per_distance - 1) * lanes.narrowness;
  const Float8 cos_emitter = stdx::max(spread, Float8(floor));
  Float8 reflected = r.bound.cosine * (r.transmits ? Float8(1) : cos_receiver) + r.bound.constant;
  if (r.bound.gloss.peak > 0) {
    const Float8 from_receiver[3] = {-to_receiver[0], -to_receiver[1], -to_receiver[2]};
    const Float8 axis[3] = {r.mirrored.x, r.mirrored.y, r.mirrored.z};
    const Float8 cosine = lane_cone_cosine(from_receiver, centre_distance2, lanes.radius2, axis, 1, 0);
    reflected += bounded_gloss<Float8>(r.bound.gloss.peak, r.bound.gloss.tail, r.bound.gloss.alpha2, cosine);
  }
  const Float8 power = reflected * flux_towards(lanes, gloss, to_receiver, centre_distance2) * cos_emitter;
  Float8 result = stdx::min(power * per_distance * per_distance, lanes.cap);
  stdx::where(!(distance2 > 0), result) = stdx::min(lanes.cap, power);  // a VPL in the receiver's place
  stdx::where(power == 0, result) = 0;
  return result;
}

/// About the directional albedo that the bound stands for: falloff() covers 4 pi alpha^2 sr.
float albedo_of(const ReflectionBound& bound) {
  return bound.cosine + bound.constant + 4 * bound.gloss.alpha2 * bound.gloss.peak;
}

}  // namespace

TileLaw::TileLaw(std::span<const Receiver> receivers, const TileLawSettings& settings) : settings_(settings) {
  Bounds3 box;
  ConeUnion normals;
  bool transmits = false;
  for (const Receiver& r : receivers) {
    box.extend(r.position);
    normals.add_axis({as_vec(r.normal), 1});
    transmits |= r.transmits;
  }
  normals.close_axes();
  for (const Receiver& r : receivers) normals.open_to({as_vec(r.normal), 1});
  centre_ = box.centre();
  radius_ = 0.5f * length(box.diagonal());
  normals_ = transmits ? Cone{{0, 0, 1}, -1} : normals.result();

  choose_representatives(receivers);
}

void TileLaw::choose_representatives(std::span<const Receiver> receivers) {
  const float per_radius2 = radius_ > 0 ? 1 / (radius_ * radius_) : 0;
  const auto dissimilarity = [&](const Receiver& a, const Receiver& b) {
    return distance_squared(a.position, b.position) * per_radius2 + length_squared(as_vec(a.normal) - as_vec(b.normal));
  };
  std::vector<float> nearest(receivers.size(), k_infinity);
  std::vector<std::size_t> represented_by(receivers.size(), 0);
  std::array<std::size_t, k_most_representatives> chosen{};
  std::size_t next = receivers.size() / 2;
  while (representative_count_ < representatives_.size()) {
    chosen[representative_count_] = next;
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      const float d = dissimilarity(receivers[i], receivers[chosen[representative_count_]]);
      if (d < nearest[i]) nearest[i] = d, represented_by[i] = representative_count_;
      if (nearest[i] > nearest[farthest]) farthest = i;
    }
    ++representative_count_;
    if (!(nearest[farthest] > 0)) break;
    next = farthest;
  }
  std::array<float, k_most_representatives> share{};
  for (const std::size_t r : represented_by) share[r] += 1 / static_cast<float>(receivers.size());
  for (std::size_t i = 0; i < representative_count_; ++i) {
    const Receiver& receiver = receivers[chosen[i]];
    const float albedo = albedo_of(receiver.bound);
    representatives_[i] = {receiver, albedo > 0 ? share[i] / albedo : 0};
  }
}

[[gnu::flatten]] void TileLaw::weigh(const LightTree& tree, NodeIndex index, LightNode::Lanes& weights) const {
  const LightNode& node = tree.nodes[index];
  const GlossyLanes* gloss = tree.gloss.empty() ? nullptr : &tree.gloss[index];
  const NodeLanes lanes(node, settings_.bound);
  Float8 sum = 0;
  for (std::size_t i = 0; i < representative_count_; ++i)
    sum += representatives_[i].scale * importance(lanes, gloss, representatives_[i].receiver, settings_.cosine_floor);

  // The sphere of the receivers and that of the box, seen from each other, are one sphere seen from a point.
  const Float8 to_tile[3] = {centre_.x - lanes.centre[0], centre_.y - lanes.centre[1], centre_.z - lanes.centre[2]};
  const Float8 from_tile[3] = {-to_tile[0], -to_tile[1], -to_tile[2]};
  const Float8 distance2 = lane_dot(to_tile, to_tile);
  const Float8 tile_axis[3] = {normals_.axis.x, normals_.axis.y, normals_.axis.z};
  const auto slackened = [](Float8 cosine) {
    return stdx::max(stdx::min(cosine + k_cosine_slack, Float8(1)), Float8(0));
  };
  Float8 flux = lanes.flux;
  if (gloss) flux += load_aligned(gloss->peak);
  const auto emitted = [&](Float8 radius2) {
    return flux * slackened(lane_cone_cosine(to_tile, distance2, radius2, lanes.axis, lanes.cosine, lanes.sine));
  };
  const auto spread = [&](Float8 power, Float8 radius2) {
    const Float8 spread2 = distance2 + radius2;
    Float8 all = stdx::min(power / spread2, lanes.cap);
    stdx::where(!(spread2 > 0) && power > 0, all) = lanes.cap;
    return all;
  };
  const Float8 radius = lanes.radius + radius_, radius2 = radius * radius;
  const Float8 to_receivers = emitted(radius2) * slackened(lane_cone_cosine(from_tile, distance2, radius2, tile_axis,
                                                                            normals_.cosine, normals_.sine()));
  sum += settings_.defensive * spread(to_receivers, radius2);
  stdx::where(to_receivers == 0, sum) = 0;
  if (settings_.reach > 0) {
    const Float8 wider = radius + settings_.reach, wider2 = wider * wider;
    sum += settings_.defensive * spread(emitted(wider2), wider2);
  }
  sum.copy_to(weights, stdx::vector_aligned);
}

}  // namespace gradslc
