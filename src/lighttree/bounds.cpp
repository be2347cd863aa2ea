#include "lighttree/bounds.h"

#include <algorithm>
#include <cmath>

#include "lighttree/cluster_kernel.h"

namespace gradslc {
namespace {

/// Upper bound of the cosine between `axis` and a direction of the cone around the direction from the box's centre
/// whose half angle the box's sphere covers: cos(max(0, angle to the axis - half angle of the sphere - half angle of
/// the cone)), before slack.
float cone_cosine(Vec3 from_centre, float radius2, const Cone& cone) {
  if (cone.cosine <= -1) return 1;
  const float distance2 = length_squared(from_centre);
  if (distance2 <= radius2 || !(distance2 > 0)) return 1;
  const float cos_axis = std::clamp(dot(from_centre, cone.axis) / std::sqrt(distance2), -1.0f, 1.0f);
  const float sin_axis = std::sqrt(1 - cos_axis * cos_axis);
  const float sin_box = std::sqrt(radius2 / distance2), cos_box = std::sqrt(1 - radius2 / distance2);
  if (cos_axis >= cos_box) return 1;                               // the axis points into the box's cone of directions
  const float cos_rest = cos_axis * cos_box + sin_axis * sin_box;  // angle to the axis less the box's
  const float sin_rest = std::sqrt(std::max(0.0f, 1 - cos_rest * cos_rest));
  if (cos_rest >= cone.cosine) return 1;
  return std::min(1.0f, cos_rest * cone.cosine + sin_rest * cone.sine());
}

float slackened(float cosine) { return std::clamp(cosine + k_cosine_slack, 0.0f, 1.0f); }

/// Upper bound of the cosine at the receiver towards any point of the box.
float receiver_cosine(const Bounds3& box, const Receiver& r, float min_distance) {
  const Vec3 lower = box.lower - r.position, upper = box.upper - r.position;
  const float highest = std::max(r.normal.x * lower.x, r.normal.x * upper.x) +
                        std::max(r.normal.y * lower.y, r.normal.y * upper.y) +
                        std::max(r.normal.z * lower.z, r.normal.z * upper.z);
  if (highest >= min_distance) return 1;
  if (highest > 0) return slackened(highest / min_distance);
  // The whole box is below the horizon: the true cosine is at most highest / max distance.
  return slackened(highest / std::sqrt(box.max_distance_squared(r.position)));
}

float bounded_gloss(const GlossBound& gloss, float cosine) {
  if (gloss.peak == 0) return 0;
  const float s2 = std::max(0.0f, 0.5f - 0.5f * std::min(1.0f, cosine + k_cosine_slack));
  return std::min(gloss.peak, gloss.tail * gloss_falloff(s2, gloss.alpha2));
}

float bounded_importance(float power, float distance2, float capped_flux, float bound) {
  if (power == 0) return 0;
  const float cap = capped_flux * bound;
  return distance2 > 0 ? std::min(power / distance2, cap) : cap;
}

}  // namespace

Receiver make_receiver(const GatherPoint& point) {
  const ShadedPoint& x = point.x;
  return {x.point.position, x.frame.n, x.bsdf.connectable_bound(x.wo, point.lobes),
          x.to_world(mirrored(x.wo, {0, 0, 1})), x.bsdf.transmits(point.lobes.only_connectable())};
}

ClusterTerms cluster_terms(const LightCluster& cluster, const Receiver& r) {
  ClusterTerms terms;
  const Bounds3& box = cluster.box;
  terms.min_distance2 = box.min_distance_squared(r.position);
  terms.max_distance2 = box.max_distance_squared(r.position);
  const float cos_receiver = receiver_cosine(box, r, std::sqrt(terms.min_distance2));
  const Vec3 to_receiver = r.position - box.centre();
  const float radius2 = 0.25f * length_squared(box.diagonal());
  float reflected = r.bound.cosine * cos_receiver;
  if (cos_receiver > 0 || r.transmits) reflected += r.bound.constant;
  if (cos_receiver > 0 && r.bound.gloss.peak > 0)
    reflected += bounded_gloss(r.bound.gloss, cone_cosine(-to_receiver, radius2, {r.mirrored, 1}));
  if (reflected == 0) return terms;
  const float flux = cluster.flux + bounded_gloss(cluster.gloss, cone_cosine(to_receiver, radius2, cluster.mirrored));
  terms.power = reflected * flux * slackened(cone_cosine(to_receiver, radius2, cluster.normals));
  return terms;
}

float cluster_bound(const LightCluster& cluster, const Receiver& receiver, float bound) {
  const ClusterTerms terms = cluster_terms(cluster, receiver);
  return bounded_importance(terms.power, terms.min_distance2, cluster.capped_flux, bound);
}

[[gnu::flatten]] void evaluate_children(const LightTree& tree, NodeIndex index, std::span<const Receiver> receivers,
                                        float bound, ChildWeights& weights) {
  const LightNode& node = tree.nodes[index];
  const GlossyLanes* gloss = tree.gloss.empty() ? nullptr : &tree.gloss[index];
  const Float8 cap = load_aligned(node.capped_flux) * bound;
  Float8 nearest = 0, farthest = 0, flux_alone = 0;
  bool inside = false;
  for (const Receiver& receiver : receivers) {
    const LaneTerms terms = lane_terms(node, gloss, receiver);
    const Float8 plain = terms.power / terms.min_distance2;
    Float8 near_importance = stdx::min(plain, cap);
    stdx::where(terms.min_distance2 == 0, near_importance) = cap;
    stdx::where(terms.power == 0, near_importance) = 0;
    Float8 far_importance = stdx::min(terms.power / terms.max_distance2, cap);
    stdx::where(terms.power == 0, far_importance) = 0;
    nearest += near_importance, farthest += far_importance;
    flux_alone += terms.power;
    inside |= stdx::any_of(terms.min_distance2 == 0 && terms.power > 0);
  }
  nearest.copy_to(weights.bound, stdx::vector_aligned);
  (inside && bound == k_infinity ? flux_alone : nearest).copy_to(weights.nearest, stdx::vector_aligned);
  farthest.copy_to(weights.farthest, stdx::vector_aligned);
}

ChildProbabilities child_probabilities(const ChildWeights& weights, LaneMask lanes) {
  double nearest = 0, farthest = 0;
  for (int lane = 0; lane < LightNode::k_width; ++lane) {
    if ((lanes >> lane & 1) == 0) continue;
    nearest += static_cast<double>(weights.nearest[lane]);
    farthest += static_cast<double>(weights.farthest[lane]);
  }
  ChildProbabilities probabilities{};
  if (!(nearest > 0 && farthest > 0)) return probabilities;
  const double per_nearest = 0.5 / nearest, per_farthest = 0.5 / farthest;
  for (int lane = 0; lane < LightNode::k_width; ++lane) {
    if ((lanes >> lane & 1) == 0) continue;
    probabilities.lane[lane] = static_cast<double>(weights.nearest[lane]) * per_nearest +
                               static_cast<double>(weights.farthest[lane]) * per_farthest;
  }
  return probabilities;
}

}  // namespace gradslc
