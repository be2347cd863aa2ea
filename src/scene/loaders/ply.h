#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/loaders/mesh_file.h"
#include "scene/mesh.h"

namespace gradslc {

/// The polygons of a PLY file (ascii or binary of either byte order) as triangles in world space, cut into fans:
/// element "vertex" with x y z and, where given, nx ny nz and uvs (u v, s t, texture_u texture_v or texture_s
/// texture_t), and element "face" with the list vertex_indices or vertex_index. Other elements and properties are
/// skipped. Normals by finish_normals(). Throws Error (input) with line and column, or in binary data the byte.
///
/// Written here because the library that Debian has, RPly, says of an error neither line nor byte, reads text with the
/// C library's locale-dependent functions and hands over one value per call.
TriangleMesh load_ply(const std::filesystem::path& file, const MeshFileOptions& options);
/// The same for a file in memory; `file` is its name in messages.
TriangleMesh parse_ply(std::string_view bytes, const std::string& file, const MeshFileOptions& options);

}  // namespace gradslc
