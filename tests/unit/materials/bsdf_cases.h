#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "materials/material.h"

namespace gradslc {

/// What must hold for one BSDF beside what holds for all.
struct BsdfTraits {
  bool both_sides = false;  ///< scatters light that comes to either side, or lets it pass
  bool transmits = false;
  bool white = false;  ///< loses no energy at all, what passes straight through included
  float eta = 1;       ///< index inside over index outside where light is refracted
};

/// One BSDF under test.
struct BsdfCase {
  const char* name;        ///< of the case
  const char* registered;  ///< name in bsdf_registry()
  MaterialPtr material;
  BsdfTraits traits = {};
};
void PrintTo(const BsdfCase& c, std::ostream* stream);

/// The only list of BSDFs under test.
std::vector<BsdfCase> bsdf_cases();

Vec3 mirrored_side(Vec3 w);
/// Near normal, oblique in several azimuths, grazing; and the same from below.
std::vector<Vec3> known_directions();

/// A BSDF as it is for one known direction, in its own frame.
struct SeenBsdf {
  Bsdf bsdf;
  Vec3 known;  ///< local
};
SeenBsdf seen_from(const BsdfCase& c, Vec3 known);

}  // namespace gradslc
