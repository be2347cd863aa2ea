#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/simd.h"
#include "lighttree/bounds.h"
#include "lighttree/comb.h"

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

/// A tile's candidates side by side, and a pixel's choice among them (DESIGN 5, step 2): a draw's probability is
/// proportional to the largest channel of the candidate's unshadowed, bounded contribution over its own probability:
/// exactly where both lobes are Lambert's, else nearly so (the bounds of the lobes stand for them), and positive
/// wherever the contribution is. Keeps its memory between uses; one per thread.
class CandidateSet {
 public:
  /// `comb_size`: of draw_candidates().
  void assign(const VplSet& set, std::span<const Candidate> candidates, int comb_size);
  std::size_t size() const { return size_; }

  /// Target of every candidate; the sum is what choose() draws from.
  void evaluate(const CandidateReceiver& receiver, float bound);
  /// Systematic resampling of `samples` draws with `u` in [0,1). Empty if no candidate contributes.
  void choose(int samples, double u, std::vector<CandidateDraw>& draws) const;

  std::uint32_t vpl(std::uint32_t candidate) const { return vpls_[candidate]; }
  /// Count over expected count: what a contribution of this candidate is multiplied by.
  float weight(std::uint32_t candidate) const { return weights_[candidate]; }
  /// Where both lobes are Lambert's: weight() times the contribution, which evaluate() has found.
  Rgb contribution(const CandidateReceiver& receiver, std::uint32_t candidate) const;
  bool is_lambert(std::uint32_t candidate) const { return lambert_[candidate] != 0; }
  /// For tests: what evaluate() has found.
  float target(std::uint32_t candidate) const;

 private:
  static constexpr std::size_t k_lanes = FloatV::size();
  struct alignas(64) Lanes {
    std::array<float, k_lanes> values;
  };
  using Column = std::vector<Lanes>;
  static float at(const Column& column, std::size_t i) { return column[i / k_lanes].values[i % k_lanes]; }
  FloatV load(const Column& column, std::size_t group) const {
    return load_aligned<FloatV>(column[group].values.data());
  }

  std::size_t size_ = 0;
  bool glossy_ = false;
  std::vector<std::uint32_t> vpls_;
  std::vector<float> weights_;
  std::vector<std::uint8_t> lambert_;
  Column position_[3], geometric_[3], shading_[3], flux_[3], strength_, vertex_;
  Column broad_, peak_, tail_, alpha2_, mirrored_[3];
  // Results of evaluate(): geometric factors, and targets summed up lane by lane.
  Column geometry_, summed_;
};

}  // namespace gradslc
