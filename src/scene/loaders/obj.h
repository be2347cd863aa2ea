#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/loaders/transform.h"
#include "scene/mesh.h"

namespace gradslc {

struct ObjOptions {
  Transform to_world;
  bool face_normals = false;    ///< flat, whatever normals the file has
  bool flip_tex_coords = true;  ///< v becomes 1 - v, Mitsuba's default
};

/// The polygons of a Wavefront OBJ file as triangles in world space, all groups and materials in one mesh. Polygons are
/// cut into fans. Where no face names a normal, smooth ones are computed. Triangles whose normals face away from their
/// winding are wound the other way, as Mitsuba lets vertex normals choose the side.
/// Throws Error (input) with line and column.
TriangleMesh load_obj(const std::filesystem::path& file, const ObjOptions& options);
/// The same for text in memory; `file` is its name in messages.
TriangleMesh parse_obj(std::string_view text, const std::string& file, const ObjOptions& options);

}  // namespace gradslc
