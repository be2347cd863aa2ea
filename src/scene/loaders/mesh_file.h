#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"
#include "scene/loaders/transform.h"

namespace gradslc {

/// What the loaders of mesh files are told.
struct MeshFileOptions {
  Transform to_world;
  bool face_normals = false;     ///< flat, whatever normals the file has
  bool flip_tex_coords = false;  ///< v becomes 1 - v
  std::optional<double>
      max_smooth_angle;  ///< degrees; new normals that keep edges sharper than that, see mesh_normals.h
};

/// Line and column of a byte of a text, and the line itself where it is not too long to be shown.
SourcePosition position_in_text(std::string_view text, const std::string& file, std::size_t offset);

}  // namespace gradslc
