#pragma once

#include <span>

#include "lighttree/light_tree.h"
#include "vpl/connection.h"

namespace gradslc {

/// What the tree knows of a gather point.
struct Receiver {
  Point3 position;
  Normal3 normal;          ///< shading normal on the side that lobes which reflect are lit from
  ReflectionBound bound;   ///< of pi f_c |cos| at the receiver
  Vec3 mirrored;           ///< unit, where its gloss points
  bool transmits = false;  ///< lit from both sides
};
Receiver make_receiver(const GatherPoint& point);

/// A distance-free factor of a cluster's contribution, and the squared distances to its box.
struct ClusterTerms {
  float power = 0;  ///< bound of pi f_c |cos| at the receiver times the VPLs' flux and cosine towards it, >= 0; 0 only
                    ///< where nothing of the cluster lights the receiver
  float min_distance2 = 0, max_distance2 = 0;
};
ClusterTerms cluster_terms(const LightCluster& cluster, const Receiver& receiver);

/// pi^2 times an upper bound of the luminance that the cluster's VPLs send to the receiver together, unshadowed, when
/// connections are bounded by `bound` (infinite: plain gathering; then infinite for receivers inside the box). 0 only
/// if all of them contribute 0.
float cluster_bound(const LightCluster& cluster, const Receiver& receiver, float bound);

/// The children of one node as receivers see them, summed over the receivers.
struct ChildWeights {
  alignas(32) LightNode::Lanes bound;              ///< cluster_bound()
  alignas(32) LightNode::Lanes nearest, farthest;  ///< importance by the smallest and the largest distance to the boxes
};
/// With SIMD; cluster_terms() is its scalar twin. `nearest` is the bound, or flux alone as soon as a box holds a
/// receiver and connections are not bounded (Yuksel 2019).
void evaluate_children(const LightTree& tree, NodeIndex node, std::span<const Receiver> receivers, float bound,
                       ChildWeights& weights);

/// Some of a node's children: bit i stands for lane i.
using LaneMask = std::uint32_t;
constexpr LaneMask k_all_lanes = 0xff;

/// Probabilities with which descent goes on from a node to its children in `lanes`: the mean of the probabilities from
/// smallest and from largest distances (Lin and Yuksel 2020, section 4.2, for two children). They sum to 1, or are all
/// 0 where nothing below lights any receiver. Sampling, pmf and shared laws all call this and nothing else.
struct ChildProbabilities {
  double lane[LightNode::k_width];
};
ChildProbabilities child_probabilities(const ChildWeights& weights, LaneMask lanes);

}  // namespace gradslc
