#pragma once

#include <span>
#include <string>
#include <variant>

#include "materials/bsdf.h"
#include "materials/property_reader.h"
#include "materials/texture.h"

namespace gradslc {

struct DiffuseMaterial {
  Texture reflectance;
};
struct ConductorMaterial {
  Rgb eta, k;
  Texture specular_reflectance;
};

/// What a scene file says of a surface: a BSDF with its textures.
struct Material {
  std::string name;  ///< id in the scene file; may be empty
  std::variant<DiffuseMaterial, ConductorMaterial> kind;
  bool two_sided = false;

  /// The BSDF at a point.
  Bsdf resolve(Vec2 uv) const;
  /// Whether a lobe outside the connectable ones exists anywhere on it.
  bool has_other_lobes(const LobeSelection& lobes) const;
  /// Upper bound of the connectable lobes' albedo anywhere on it, largest channel.
  float max_connectable_albedo(const LobeSelection& lobes) const;
};

struct BsdfEntry {
  const char* name;  ///< as in scene files
  const char* meaning;
  Material (*make)(PropertyReader& properties);
};
/// The only list of BSDF plug-ins.
std::span<const BsdfEntry> bsdf_registry();

}  // namespace gradslc
