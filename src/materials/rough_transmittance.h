#pragma once

#include <array>

#include "materials/microfacet.h"

namespace gradslc {

/// How much light a rough interface between dielectrics lets pass when it comes from outside, by the cosine of its
/// direction: what roughplastic's base is lit and seen through. Scattered once, as Mitsuba 0.6 tabulates it: what
/// facets mask counts as not passed. Tabulated when made; error below 1e-3.
class RoughTransmittance {
 public:
  /// `microfacet` isotropic; `eta` > 0: index inside over index outside.
  RoughTransmittance(const Microfacet& microfacet, float eta);

  /// In [0,1]; cos_theta in [0,1].
  float operator()(float cos_theta) const;
  float max() const { return max_; }
  /// For diffuse light from outside: the integral of 2 T(cos) cos.
  float diffuse() const { return diffuse_; }
  /// For diffuse light from inside: diffuse() / eta^2, by reciprocity.
  float escaping() const { return diffuse_ * inv_eta2_; }
  float inv_eta2() const { return inv_eta2_; }

 private:
  static constexpr int k_intervals = 128;
  std::array<float, k_intervals + 1> table_{};  // by sqrt(cos)
  float max_ = 0, diffuse_ = 0, inv_eta2_ = 1;
};

}  // namespace gradslc
