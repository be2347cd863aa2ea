#pragma once

#include "core/simd.h"
#include "lighttree/bounds.h"

namespace gradslc {

/// Bounds of cosines carry this much slack: rounding must not turn a small true cosine into a bound of 0. A sine from a
/// rounded cosine of nearly 1 is off by the root of a few ulp, 6e-4.
constexpr float k_cosine_slack = 1e-3f;

/// ClusterTerms of a node's eight children.
struct LaneTerms {
  Float8 power, min_distance2, max_distance2;
};

/// cos(max(0, a - s - c)): a the angle between `axis` and the direction `to` from a sphere's centre, s the half angle
/// that the sphere covers as seen from there, c the cone's. All scaled by |to|^2, so that no angle is computed.
inline Float8 lane_cone_cosine(const Float8 (&to)[3], Float8 distance2, Float8 radius2, const Float8 (&axis)[3],
                               Float8 cosine, Float8 sine) {
  const Float8 along = to[0] * axis[0] + to[1] * axis[1] + to[2] * axis[2];  // cos(a) |to|
  const Float8 across = stdx::sqrt(stdx::max(distance2 - along * along, Float8(0)));
  const Float8 radius = stdx::sqrt(radius2);
  const Float8 tangent = stdx::sqrt(stdx::max(distance2 - radius2, Float8(0)));  // cos(s) |to|
  const Float8 cos_rest = along * tangent + across * radius;                     // cos(a - s) |to|^2
  const Float8 sin_rest = across * tangent - along * radius;
  Float8 result = (cos_rest * cosine + sin_rest * sine) / distance2;
  // Within the sphere's or the cone's directions, or a receiver within the sphere. The scaled comparison's rounding
  // falls within the slack.
  stdx::where(sin_rest <= 0 || cos_rest >= cosine * distance2 || distance2 <= radius2, result) = 1;
  return result;
}

/// A GlossBound towards a direction whose cosine to the mirrored one is `cosine` at most.
template <class Vector>
Vector bounded_gloss(Vector peak, Vector tail, Vector alpha2, Vector cosine) {
  const Vector s2 = stdx::max(0.5f - 0.5f * stdx::min(cosine + k_cosine_slack, Vector(1)), Vector(0));
  return stdx::min(peak, tail * gloss_falloff(s2, alpha2));
}

/// The SIMD twin of cluster_terms().
inline LaneTerms lane_terms(const LightNode& node, const GlossyLanes* gloss, const Receiver& r) {
  const float position[3] = {r.position.x, r.position.y, r.position.z};
  const float normal[3] = {r.normal.x, r.normal.y, r.normal.z};
  const Float8 zero = 0;
  Float8 min_distance2 = 0, max_distance2 = 0, highest = 0, distance2 = 0, radius2 = 0;
  Float8 to_receiver[3];
  for (int i = 0; i < 3; ++i) {
    const Float8 lower = load_aligned(node.lower[i]), upper = load_aligned(node.upper[i]);
    const Float8 below = lower - position[i], above = upper - position[i];  // both > 0 or both < 0: outside
    const Float8 outside = stdx::max(stdx::max(below, -above), zero), far = stdx::max(-below, above);
    min_distance2 += outside * outside, max_distance2 += far * far;
    highest += normal[i] * (normal[i] > 0 ? above : below);
    const Float8 centre = lower + 0.5f * (upper - lower), half = 0.5f * (upper - lower);
    to_receiver[i] = position[i] - centre;
    distance2 += to_receiver[i] * to_receiver[i], radius2 += half * half;
  }
  // As receiver_cosine(): above the horizon the nearest point counts, below it the farthest.
  Float8 horizon2 = max_distance2;
  stdx::where(highest > 0, horizon2) = min_distance2;
  Float8 cos_receiver = stdx::min(highest / stdx::sqrt(horizon2) + k_cosine_slack, Float8(1));
  stdx::where(highest >= 0 && highest * highest >= min_distance2, cos_receiver) = 1;
  cos_receiver = stdx::max(cos_receiver, zero);
  const auto lit = cos_receiver > 0;

  Float8 reflected = r.bound.cosine * cos_receiver;
  if (r.bound.constant > 0) {
    Float8 constant = r.bound.constant;
    if (!r.transmits) stdx::where(!lit, constant) = 0;
    reflected += constant;
  }
  if (r.bound.gloss.peak > 0) {
    const Float8 from_receiver[3] = {-to_receiver[0], -to_receiver[1], -to_receiver[2]};
    const Float8 axis[3] = {r.mirrored.x, r.mirrored.y, r.mirrored.z};
    const Float8 cosine = lane_cone_cosine(from_receiver, distance2, radius2, axis, 1, 0);
    Float8 peak = bounded_gloss<Float8>(r.bound.gloss.peak, r.bound.gloss.tail, r.bound.gloss.alpha2, cosine);
    stdx::where(!lit, peak) = 0;
    reflected += peak;
  }

  Float8 flux = load_aligned(node.flux);
  if (gloss) {
    const Float8 axis[3] = {load_aligned(gloss->axis[0]), load_aligned(gloss->axis[1]), load_aligned(gloss->axis[2])};
    const Float8 cosine =
        lane_cone_cosine(to_receiver, distance2, radius2, axis, load_aligned(gloss->cosine), load_aligned(gloss->sine));
    flux += bounded_gloss<Float8>(load_aligned(gloss->peak), load_aligned(gloss->tail), load_aligned(gloss->alpha2),
                                  cosine);
  }
  const Float8 axis[3] = {load_aligned(node.axis[0]), load_aligned(node.axis[1]), load_aligned(node.axis[2])};
  const Float8 cos_emitter =
      lane_cone_cosine(to_receiver, distance2, radius2, axis, load_aligned(node.cosine), load_aligned(node.sine));
  const Float8 slackened = stdx::max(stdx::min(cos_emitter + k_cosine_slack, Float8(1)), zero);
  return {reflected * flux * slackened, min_distance2, max_distance2};
}

}  // namespace gradslc
