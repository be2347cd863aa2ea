#include "lighttree/bounds.h"

#include <algorithm>
#include <cmath>

namespace gradslc {
namespace {

/// Bounds of cosines carry this much slack: rounding must not turn a small true cosine into a bound of 0.
constexpr float k_cosine_slack = 1e-4f;

float slackened_cosine(float cosine) { return std::clamp(cosine + k_cosine_slack, 0.0f, 1.0f); }

/// Upper bound of the cosine at the receiver towards any point of the box.
float receiver_cosine(const Bounds3& box, const Receiver& r, float min_distance) {
  const Vec3 lower = box.lower - r.position, upper = box.upper - r.position;
  const float highest = std::max(r.normal.x * lower.x, r.normal.x * upper.x) +
                        std::max(r.normal.y * lower.y, r.normal.y * upper.y) +
                        std::max(r.normal.z * lower.z, r.normal.z * upper.z);
  if (highest >= min_distance) return 1;
  if (highest > 0) return slackened_cosine(highest / min_distance);
  // The whole box is below the horizon: the true cosine is at most highest / max distance.
  return slackened_cosine(highest / std::sqrt(box.max_distance_squared(r.position)));
}

/// Upper bound of the cosine between a normal of the cone and the direction from any point of the box to the receiver:
/// cos(max(0, angle to the axis - half angle of the box's sphere - half angle of the cone)).
float emitter_cosine(const LightNode& node, Point3 receiver) {
  if (node.cone_cos <= -1) return 1;
  const Vec3 to_receiver = receiver - node.box.centre();
  const float distance2 = length_squared(to_receiver);
  const float radius2 = 0.25f * length_squared(node.box.diagonal());
  if (distance2 <= radius2 || !(distance2 > 0)) return 1;
  const float cos_axis = std::clamp(dot(to_receiver, node.cone_axis) / std::sqrt(distance2), -1.0f, 1.0f);
  const float sin_axis = std::sqrt(1 - cos_axis * cos_axis);
  const float sin_box = std::sqrt(radius2 / distance2), cos_box = std::sqrt(1 - radius2 / distance2);
  if (cos_axis >= cos_box) return 1;                               // the axis points into the box's cone of directions
  const float cos_rest = cos_axis * cos_box + sin_axis * sin_box;  // angle to the axis less the box's
  const float sin_rest = std::sqrt(std::max(0.0f, 1 - cos_rest * cos_rest));
  if (cos_rest >= node.cone_cos) return 1;
  const float sin_cone = std::sqrt(std::max(0.0f, 1 - node.cone_cos * node.cone_cos));
  return slackened_cosine(cos_rest * node.cone_cos + sin_rest * sin_cone);
}

/// Importance of a cluster at a squared distance > 0, capped where connections are bounded.
double importance(const LightNode& node, float reflectance, float distance2, float bound) {
  if (reflectance == 0) return 0;
  const double plain =
      static_cast<double>(node.flux) * static_cast<double>(reflectance) / static_cast<double>(distance2);
  return std::min(plain, static_cast<double>(node.capped_flux) * static_cast<double>(bound));
}

/// Weights of two siblings at one kind of distance, summed over receivers; flux alone as soon as that distance is 0
/// for any receiver and sibling, so that all summands have one unit.
struct SiblingWeights {
  double left = 0, right = 0, left_flux = 0, right_flux = 0;
  bool flux_alone = false;

  std::optional<double> left_probability() const {
    const double l = flux_alone ? left_flux : left, r = flux_alone ? right_flux : right;
    return l + r > 0 ? std::optional(l / (l + r)) : std::nullopt;
  }
};

}  // namespace

Receiver make_receiver(const GatherPoint& point) {
  const ShadedPoint& x = point.x;
  return {x.point.position, x.frame.n, x.bsdf.connectable_bound(x.wo, point.lobes),
          x.bsdf.transmits(point.lobes.only_connectable())};
}

ClusterTerms cluster_terms(const LightNode& node, const Receiver& r) {
  ClusterTerms terms;
  terms.min_distance2 = node.box.min_distance_squared(r.position);
  terms.max_distance2 = node.box.max_distance_squared(r.position);
  const float cos_receiver = receiver_cosine(node.box, r, std::sqrt(terms.min_distance2));
  const float constant = cos_receiver > 0 || r.transmits ? r.bound.constant : 0;
  const float reflected = r.bound.cosine * cos_receiver + constant;
  if (reflected > 0) terms.reflectance = reflected * emitter_cosine(node, r.position);
  return terms;
}

float cluster_bound(const LightNode& node, std::span<const Receiver> receivers, float bound) {
  float sum = 0;
  for (const Receiver& r : receivers) {
    const ClusterTerms terms = cluster_terms(node, r);
    if (terms.reflectance == 0) continue;
    const float plain = terms.min_distance2 > 0 ? node.flux * terms.reflectance / terms.min_distance2 : k_infinity;
    sum += node.flux > 0 ? std::min(plain, node.capped_flux * bound) : 0;
  }
  return sum;
}

std::optional<double> left_probability(const LightTree& tree, NodeIndex index, std::span<const Receiver> receivers,
                                       float bound) {
  const LightNode& left = tree.nodes[tree.nodes[index].left];
  const LightNode& right = tree.nodes[tree.nodes[index].right];
  SiblingWeights nearest, farthest;
  const auto add = [&](SiblingWeights& w, float l_reflectance, float l_distance2, float r_reflectance,
                       float r_distance2) {
    w.left_flux += static_cast<double>(left.flux * l_reflectance);
    w.right_flux += static_cast<double>(right.flux * r_reflectance);
    if (!(l_distance2 > 0 && r_distance2 > 0)) w.flux_alone = true;
    if (w.flux_alone) return;
    w.left += importance(left, l_reflectance, l_distance2, bound);
    w.right += importance(right, r_reflectance, r_distance2, bound);
  };
  for (const Receiver& receiver : receivers) {
    const ClusterTerms l = cluster_terms(left, receiver), r = cluster_terms(right, receiver);
    add(nearest, l.reflectance, l.min_distance2, r.reflectance, r.min_distance2);
    add(farthest, l.reflectance, l.max_distance2, r.reflectance, r.max_distance2);
  }
  const auto p_nearest = nearest.left_probability(), p_farthest = farthest.left_probability();
  if (!p_nearest || !p_farthest) return std::nullopt;
  return 0.5 * (*p_nearest + *p_farthest);
}

}  // namespace gradslc
