#pragma once

#include <memory>

#include "reconstruction/reconstruction.h"

namespace gradslc {

// One per file of the same name, for the registry.
std::unique_ptr<Reconstruction> make_none();
std::unique_ptr<Reconstruction> make_l2();
std::unique_ptr<Reconstruction> make_l1();
std::unique_ptr<Reconstruction> make_weighted();
std::unique_ptr<Reconstruction> make_feature();
std::unique_ptr<Reconstruction> make_denoise();

}  // namespace gradslc
