#pragma once

#include "integrators/part_values.h"

namespace gradslc {

/// How a BSDF's value splits into its connectable and its other lobes (f = f_c + f_s), each times cosine over pdf.
struct LobeWeights {
  Rgb connectable, other;
  Rgb total() const { return connectable + other; }
};

/// Throughput of a path whose radiance is not split by parts.
struct PlainThroughput {
  static constexpr bool k_by_lobes = false;  ///< needs no more than a sampled direction's weight
  Rgb value{1};

  PlainThroughput scattered(const LobeWeights& w) const { return {value * w.total()}; }
  PlainThroughput scaled(float s) const { return {value * s}; }
  /// Past crossings: the parts stay what they are.
  PlainThroughput transmitted(Rgb transmittance) const { return {value * transmittance}; }
  bool is_black() const { return gradslc::is_black(value); }
  float largest() const { return max_channel(value); }
  Rgb total() const { return value; }
  /// Adds light that arrives through this throughput; all of it is booked as one part.
  void collect(Rgb radiance, PartValues& sum) const { sum[Part::direct] += value * radiance; }
};

/// Throughput by what the path has met, for the parts of DESIGN 4. It starts as prefix; the first connectable lobe
/// makes it gathered (the next vertex is y); y's connectable lobe makes it vpl (or what compensates VPLs), y's others
/// specular.
struct LabelledThroughput {
  static constexpr bool k_by_lobes = true;
  Rgb prefix{1}, gathered, vpl, specular;
  Part vpl_part = Part::vpl;  ///< where the light of `vpl` is booked

  /// A path that has met no connectable lobe yet.
  static LabelledThroughput camera_path(Rgb throughput, Part vpl_part = Part::vpl) {
    return {throughput, Rgb(), Rgb(), Rgb(), vpl_part};
  }
  LabelledThroughput scattered(const LobeWeights& w) const {
    return {prefix * w.other, prefix * w.connectable, vpl * w.total() + gathered * w.connectable,
            specular * w.total() + gathered * w.other, vpl_part};
  }
  LabelledThroughput scaled(float s) const { return {prefix * s, gathered * s, vpl * s, specular * s, vpl_part}; }
  LabelledThroughput transmitted(Rgb t) const { return {prefix * t, gathered * t, vpl * t, specular * t, vpl_part}; }
  bool is_black() const {
    return gradslc::is_black(prefix) && gradslc::is_black(gathered) && gradslc::is_black(vpl) &&
           gradslc::is_black(specular);
  }
  float largest() const { return max_channel(total()); }
  Rgb total() const { return prefix + gathered + vpl + specular; }
  void collect(Rgb radiance, PartValues& sum) const {
    sum[Part::prefix] += prefix * radiance;
    sum[Part::direct] += gathered * radiance;
    sum[vpl_part] += vpl * radiance;
    sum[Part::specular] += specular * radiance;
  }
};

}  // namespace gradslc
