#pragma once

#include <experimental/simd>

namespace gradslc {

/// Vectors of floats for the few kernels that need them (Parallelism TS v2). Each kernel has a scalar twin that tests
/// compare it with.
namespace stdx = std::experimental;

/// As wide as the processor that is compiled for.
using FloatV = stdx::native_simd<float>;
/// Eight lanes, for data that come in eights.
using Float8 = stdx::simd<float, stdx::simd_abi::deduce_t<float, 8>>;

/// `array` must be aligned to the vector's size.
template <class Vector = Float8>
Vector load_aligned(const float* array) {
  return Vector(array, stdx::vector_aligned);
}

template <class Vector>
Vector lane_dot(const Vector (&a)[3], const Vector (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace gradslc
