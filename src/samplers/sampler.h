#pragma once

#include <cstdint>
#include <span>

#include "core/hash.h"
#include "core/vec.h"
#include "samplers/independent.h"
#include "samplers/sobol.h"

namespace gradslc {

/// What a random number is used for. A number is named by its use and an index (usually the vertex of the path), so
/// that adding one use does not shift the others, and replaying a path needs no recording: ask again (DESIGN 9). A new
/// use goes to the end: a use's place is part of the random numbers' names.
enum class Use : std::uint16_t {
  pixel,               ///< position within the pixel
  lens,                ///< position on the lens
  lobe,                ///< connectable or other lobe, and the component within
  direction,           ///< direction of a BSDF sample
  emitter,             ///< which emitter next-event estimation connects to, and where on it
  roulette,            ///< Russian roulette
  compensation_lobe,   ///< the ray that compensates bounding: component
  compensation,        ///< the ray that compensates bounding: direction
  emission_emitter,    ///< light tracing: which emitter
  emission_point,      ///< light tracing: position on it
  emission_direction,  ///< light tracing: direction from it
  descent,             ///< descent from a node of the cut; index = node of the cut and level
  vpl_choice,          ///< uniform or power sampling of VPLs
  group_offset,        ///< offset of the blocks or tiles of a pass
  tile_comb,           ///< place of the comb that draws a tile's candidates
  candidate_choice,    ///< place of the comb that draws among them for a pixel
  ray_count,           ///< rounding of the number of rays of a gather
  crossing,            ///< whether a path passes straight through a surface or is scattered
  candidate_subset,    ///< which of a tile's candidates a vertex behind a ray chooses among
  lobe_kind,           ///< of gpt: which kind of lobe a direction is taken to be from, for its shift
};

enum class SamplerKind : std::uint8_t { independent, sobol };

struct SamplerEntry {
  const char* name;
  SamplerKind kind;
  const char* meaning;
};
/// The only list of samplers.
std::span<const SamplerEntry> sampler_registry();

/// The random numbers of one sample: a pure function of (kind, seed, stream, sample, use, index), without state.
/// `stream` is what is sampled (a pixel, a group of pixels, the light paths); `sample` counts its samples, and a
/// low-discrepancy sampler stratifies over it. Numbers of different streams, seeds, uses and indices are independent.
/// get1, get1_double, x of get2 and u of get_choice are the same number where use and index are the same: ask for one
/// of them only.
class SampleStream {
 public:
  SampleStream(SamplerKind kind, std::uint64_t seed, std::uint64_t stream, std::uint32_t sample)
      : key_(hash_combine(seed, stream)), sample_(sample), reversed_sample_(reverse_bits(sample)), kind_(kind) {}

  /// A stream of the same sample whose numbers are independent of this one's and of other branches'.
  SampleStream branch(std::uint32_t index) const {
    SampleStream stream = *this;
    stream.key_ = hash_combine(key_, std::uint64_t{index} + 1);
    return stream;
  }

  /// In [0,1), a multiple of 2^-24.
  float get1(Use use, std::uint32_t index = 0) const { return to_unit_float(bits1(use, index)); }
  /// Both in [0,1), multiples of 2^-24, stratified in two dimensions.
  Vec2 get2(Use use, std::uint32_t index = 0) const {
    const SobolPoint bits = bits2(use, index);
    return {to_unit_float(bits.x), to_unit_float(bits.y)};
  }
  /// In [0,1), with 32 random bits: for choices among many, where a float is too coarse.
  double get1_double(Use use, std::uint32_t index = 0) const { return bits1(use, index) * 0x1p-32; }

  /// A choice among many and a place within what is chosen: as get2(), but `u` with 32 random bits, so that the rest of
  /// it that the choice leaves serves as well.
  struct Choice {
    double u;
    float v;
  };
  Choice get_choice(Use use, std::uint32_t index = 0) const {
    const SobolPoint bits = bits2(use, index);
    return {bits.x * 0x1p-32, to_unit_float(bits.y)};
  }

 private:
  /// Outputs of SplitMix64 seeded with the stream's key, by the number's name.
  std::uint64_t named_key(Use use, std::uint32_t index) const {
    return mix64(key_ + ((std::uint64_t{static_cast<std::uint16_t>(use)} << 32 | index) + 1) * k_golden_gamma);
  }
  std::uint32_t bits1(Use use, std::uint32_t index) const {
    const std::uint64_t key = named_key(use, index);
    return kind_ == SamplerKind::sobol ? sobol_coordinate(key, reversed_sample_)
                                       : static_cast<std::uint32_t>(independent_bits(key, sample_) >> 32);
  }
  SobolPoint bits2(Use use, std::uint32_t index) const {
    const std::uint64_t key = named_key(use, index);
    if (kind_ == SamplerKind::sobol) return sobol_point(key, reversed_sample_);
    const std::uint64_t bits = independent_bits(key, sample_);
    return {static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits)};
  }

  std::uint64_t key_;
  std::uint32_t sample_, reversed_sample_;
  SamplerKind kind_;
};

}  // namespace gradslc
