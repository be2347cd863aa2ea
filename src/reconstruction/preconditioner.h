#pragma once

#include <memory>

#include "reconstruction/field.h"
#include "reconstruction/screened_poisson.h"

namespace gradslc {

/// An approximate inverse M^-1 of the screened Poisson problem's matrix, symmetric and positive.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// result = M^-1 residual. `residual` is of a size that floats have room around; `scratch` is of the same resolution
  /// and may come back with anything.
  virtual void apply(const Field& residual, Field& result, Field& scratch) = 0;
};

/// The one for these weights, which must live as long: alternating directions where weights are nearly alike,
/// multigrid where they are not.
std::unique_ptr<Preconditioner> make_preconditioner(const PoissonWeights& weights);

}  // namespace gradslc
