#include "reconstruction/buffers.h"
#include "reconstruction/methods.h"

namespace gradslc {
namespace {

/// The primal image as it is: shows what a method's samples are worth without gradients.
class None final : public Reconstruction {
 public:
  void describe(ParameterVisitor&) override {}
  ReconstructionResult reconstruct(const ReconstructionInput& input) const override {
    check_primal(input.combined);
    return {.image = input.combined.primal, .statistics = {}};
  }
};

}  // namespace

std::unique_ptr<Reconstruction> make_none() { return std::make_unique<None>(); }

}  // namespace gradslc
