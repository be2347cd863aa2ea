#include "samplers/sampler.h"

#include "samplers/independent.h"
#include "samplers/sobol.h"

namespace gradslc {
namespace {

constexpr std::uint64_t named_key(std::uint64_t stream_key, Use use, std::uint32_t index) {
  const std::uint64_t name = static_cast<std::uint64_t>(use) << 32 | index;
  return mix64(stream_key ^ mix64(name + k_golden_gamma));
}

std::uint32_t bits1(SamplerKind kind, std::uint64_t key, std::uint32_t sample) {
  if (kind == SamplerKind::sobol) return sobol_coordinate(key, sample);
  return static_cast<std::uint32_t>(independent_bits(key, sample) >> 32);
}

}  // namespace

float SampleStream::get1(Use use, std::uint32_t index) const {
  return to_unit_float(bits1(kind_, named_key(key_, use, index), sample_));
}

Vec2 SampleStream::get2(Use use, std::uint32_t index) const {
  const std::uint64_t key = named_key(key_, use, index);
  if (kind_ == SamplerKind::sobol) {
    const SobolPoint point = sobol_point(key, sample_);
    return {to_unit_float(point.x), to_unit_float(point.y)};
  }
  const std::uint64_t bits = independent_bits(key, sample_);
  return {to_unit_float(static_cast<std::uint32_t>(bits >> 32)), to_unit_float(static_cast<std::uint32_t>(bits))};
}

double SampleStream::get1_double(Use use, std::uint32_t index) const {
  return bits1(kind_, named_key(key_, use, index), sample_) * 0x1p-32;
}

}  // namespace gradslc
