#pragma once

#include <array>
#include <span>

#include "lighttree/bounds.h"

namespace gradslc {

struct TileLawSettings {
  float defensive = 0.1f;     ///< share of the importances to all points that may gather; 0 leaves some of them short
  float cosine_floor = 0.2f;  ///< least cosine of the importance to one receiver
  float power_share = 0;      ///< of the candidates, which are drawn by power instead, wherever the law is not 0
  float bound = k_infinity;   ///< b of connections
  float reach = 0;  ///< vertices as far as this from receivers may gather too, with any normal; 0: there are none
};

/// How important VPLs are to all receivers of a tile (DESIGN 5): the mean of the importance to some of them, which
/// represent the others, plus `defensive` times an importance that is 0 only where nothing lights any receiver, and as
/// much of one that is 0 only where nothing lights any point within `reach` of receivers. A node's weight is an
/// estimate and no bound; what counts is that it is positive wherever a VPL below lights a receiver.
class TileLaw {
 public:
  /// `receivers`: at least one.
  TileLaw(std::span<const Receiver> receivers, const TileLawSettings& settings);

  /// Weights of a node's children.
  void weigh(const LightTree& tree, NodeIndex node, LightNode::Lanes& weights) const;
  const TileLawSettings& settings() const { return settings_; }

 private:
  struct Representative {
    Receiver receiver;
    float scale;  ///< share of the receivers; makes those of all albedos alike
  };
  static constexpr std::size_t k_most_representatives = 16;
  /// One by one, each the receiver least like those before, by position and normal (farthest-point traversal, Gonzalez
  /// 1985); each stands for the receivers that it is most like.
  void choose_representatives(std::span<const Receiver> receivers);

  std::array<Representative, k_most_representatives> representatives_;
  std::size_t representative_count_ = 0;
  // All receivers: a sphere around them, and a cone of their normals.
  Point3 centre_;
  float radius_ = 0;
  Cone normals_;
  TileLawSettings settings_;
};

}  // namespace gradslc
