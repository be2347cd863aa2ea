#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/simd.h"
#include "lighttree/bounds.h"
#include "lighttree/comb.h"
#include "vpl/connection.h"

namespace gradslc {

/// A gather point as the choice among candidates sees it.
struct CandidateReceiver {
  Receiver receiver;
  Rgb diffuse;                  ///< Lambert: pi f_c; otherwise bound.cosine in all channels
  bool lambert = false;         ///< f_c is Lambert's: the choice knows the contribution exactly
  int least_k = 0, most_k = 0;  ///< light-path vertices that count: D within max_depth and the components (DESIGN 2)
};
CandidateReceiver make_candidate_receiver(const GatherPoint& point, int least_k, int most_k);

/// A candidate drawn for a pixel.
struct CandidateDraw {
  std::uint32_t candidate;
  std::uint32_t count;  ///< how often it was drawn, >= 1
  double probability;   ///< of one draw; the expected count is the number of draws times this
};

/// Every `stride`-th vector of candidates from `first`: what a choice looks at. Vectors of one subset are spread over
/// the tree's order, so that each subset stands for the whole set.
struct CandidateSubset {
  std::uint32_t first = 0, stride = 1;
};

/// A tile's candidates side by side, and a pixel's choice among them (DESIGN 5, step 2): a draw's probability is
/// proportional to the largest channel of the candidate's unshadowed, bounded contribution over its own probability:
/// exactly where both lobes are Lambert's, else nearly so (the bounds of the lobes stand for them), and to what is
/// known of its visibility; it is positive wherever the contribution is. Keeps its memory between uses; one per thread.
class CandidateSet {
 public:
  /// `comb_size`: of draw_candidates().
  void assign(const VplSet& set, std::span<const Candidate> candidates, int comb_size);
  std::size_t size() const { return vpls_.size(); }
  /// Corrects what glossy candidates are taken for, which are known by bounds of their lobes: by the largest share of
  /// the bound that their value has towards some of the tile's points.
  void calibrate(const VplView& vpls, const LobeSelection& lobes, std::span<const Point3> towards);

  /// Remembers whether a candidate that was drawn could be seen; learn_visibility() makes the choice heed it.
  void note_visibility(std::uint32_t candidate, bool visible);
  /// From now on targets are multiplied by the root of the probability with which a candidate is seen, as far as is
  /// known from it and its neighbours in the tree's order: the best law where the rest of the contribution is known
  /// (the density that minimises the variance is the root of the second moment, and a visibility is its own square).
  /// What earlier receivers have met is independent of a later one's draws: these stay unbiased.
  void learn_visibility();

  /// One of the few subsets that the candidates fall into, each with the same probability; `u` in [0,1).
  CandidateSubset random_subset(float u) const;
  /// Finds the target of every candidate of a subset, which if it is not the whole must come from random_subset();
  /// choose() draws in proportion.
  void evaluate(const CandidateReceiver& receiver, float bound, CandidateSubset subset = {});
  /// The law that several receivers share (DESIGN 6): targets are the sums of theirs.
  void evaluate(std::span<const CandidateReceiver> receivers, float bound);
  /// Systematic resampling of `samples` draws with `u` in [0,1), in the order in which the candidates were assigned:
  /// draws are stratified over what is near together there. Probabilities are those of the subset's being chosen times
  /// the draw's among its candidates. Empty if no candidate contributes.
  void choose(int samples, double u, std::vector<CandidateDraw>& draws) const;

  std::uint32_t vpl(std::uint32_t candidate) const { return vpls_[candidate]; }
  Normal3 geometric_normal(std::uint32_t candidate) const;
  /// Count over expected count: what a contribution of this candidate is multiplied by.
  float weight(std::uint32_t candidate) const { return weights_[candidate]; }
  /// Where both lobes are Lambert's: weight() times the contribution, as evaluate() of this receiver alone has found
  /// it.
  Rgb contribution(const CandidateReceiver& receiver, std::uint32_t candidate) const;
  /// The same, found anew; only if simple() and the receiver's lobe is Lambert's.
  Rgb contribution(const CandidateReceiver& receiver, std::uint32_t candidate, float bound) const;
  /// Whether all candidates are Lambert's with one normal each.
  bool simple() const { return simple_; }
  /// As evaluate() has found it, in the unit of the largest channel of pi^2 contribution(). Of the subset only.
  float target(std::uint32_t candidate) const {
    const auto [group, lane] = place_of(candidate);
    return summed_.target((group - summed_.subset.first) / summed_.subset.stride, lane);
  }

 private:
  static constexpr std::size_t k_lanes = FloatV::size();
  /// Of as many candidates as a vector has lanes. Lanes without a candidate have no flux.
  struct Group {
    FloatV position[3], geometric[3];
    FloatV flux[3];         ///< times weight()
    FloatV inverse_pi_f_y;  ///< 1 / pi f_c(y), largest channel, where it is Lambert's, else 1
  };
  /// What only some sets need.
  struct Details {
    FloatV shading[3];                 ///< 0: lights both sides
    FloatV broad, peak, tail, alpha2;  ///< of pi f_c(y), where it is not Lambert's; else broad is 1
    FloatV mirrored[3];
  };
  /// Candidates fill one lane after the other, so that choose() goes through them in the tree's order.
  struct Place {
    std::uint32_t group, lane;
  };
  Place place_of(std::uint32_t candidate) const {
    const auto groups = static_cast<std::uint32_t>(groups_.size());
    return {candidate % groups, candidate / groups};
  }
  void put(const VplSet& set, std::size_t index);
  void evaluate_lambert(const CandidateReceiver& receiver, float bound);
  void evaluate_any(const CandidateReceiver& receiver, float bound);

  std::vector<std::uint32_t> vpls_;
  std::vector<float> weights_;
  std::vector<Group> groups_;
  std::vector<Details> details_;
  std::vector<FloatV> vertices_;
  std::vector<FloatV> tests_, hits_, visibility_;
  bool simple_ = true;  ///< Lambert VPLs whose two normals are one
  float least_vertex_ = 0, most_vertex_ = 0;
  /// Targets of a subset's vectors, summed up lane by lane.
  struct SummedTargets {
    CandidateSubset subset;
    std::vector<FloatV> sums;

    std::uint32_t group(std::uint32_t index) const { return subset.first + index * subset.stride; }
    float target(std::uint32_t index, std::uint32_t lane) const {
      return sums[index][lane] - (index > 0 ? sums[index - 1][lane] : 0);
    }
  };
  // Results of evaluate(): cosines over squared distance, bounded; targets.
  std::vector<FloatV> geometry_;
  SummedTargets summed_;
  std::vector<FloatV> shared_;
};

}  // namespace gradslc
