#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/loaders/mesh_file.h"
#include "scene/mesh.h"

namespace gradslc {

/// The polygons of a Wavefront OBJ file as triangles in world space, all groups and materials in one mesh. Polygons are
/// cut into fans. Normals by finish_normals(). Positions of vertices that no face uses are dropped.
/// Throws Error (input) with line and column.
TriangleMesh load_obj(const std::filesystem::path& file, const MeshFileOptions& options);
/// The same for text in memory; `file` is its name in messages.
TriangleMesh parse_obj(std::string_view text, const std::string& file, const MeshFileOptions& options);

}  // namespace gradslc
