#pragma once

#include <optional>
#include <span>

#include "lighttree/light_tree.h"
#include "vpl/connection.h"

namespace gradslc {

/// What the tree knows of a gather point.
struct Receiver {
  Point3 position;
  Normal3 normal;          ///< shading normal on the side that lobes which reflect are lit from
  ReflectionBound bound;   ///< of pi f_c |cos| at the receiver
  bool transmits = false;  ///< lit from both sides
};
Receiver make_receiver(const GatherPoint& point);

/// A distance-free factor of a cluster's contribution, and the squared distances to its box.
struct ClusterTerms {
  float reflectance = 0;  ///< bound of pi f_c |cos| at the receiver times that of the VPLs' cosine, >= 0; 0 only where
                          ///< nothing of the cluster lights the receiver
  float min_distance2 = 0, max_distance2 = 0;
};
ClusterTerms cluster_terms(const LightNode& node, const Receiver& receiver);

/// pi^2 times an upper bound of the luminance that the VPLs of a node send to the receivers together, unshadowed, when
/// connections are bounded by `bound` (infinite: plain gathering; then infinite for receivers inside the box). 0 only
/// if all of them contribute 0.
float cluster_bound(const LightNode& node, std::span<const Receiver> receivers, float bound);

/// Probability of descending into the left child of an inner node, in [0,1]; nullopt: nothing below can light any of
/// the receivers. The mean of the probabilities from minimum and from maximum distances to the boxes, flux alone for
/// the minimum where a receiver is inside one (Yuksel 2019; Lin and Yuksel 2020, section 4.2), summed over receivers:
/// a shared law (DESIGN 6). Sampling, pmf and shared laws all call this and nothing else.
std::optional<double> left_probability(const LightTree& tree, NodeIndex node, std::span<const Receiver> receivers,
                                       float bound);

}  // namespace gradslc
