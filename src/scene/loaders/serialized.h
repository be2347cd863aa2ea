#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "scene/loaders/mesh_file.h"
#include "scene/mesh.h"

namespace gradslc {

/// Mesh number `shape_index` (from 0) of a file in Mitsuba's .serialized format, in world space. Versions 3 (Mitsuba
/// 0.5) and 4, single and double precision; vertex colours are skipped. Normals by finish_normals(); the file may ask
/// for face normals itself. Throws Error (input) with the byte of the file near which it is wrong.
///
/// Format (Mitsuba 3 manual, "Serialized mesh loader"; little endian): for each mesh uint16 0x041C, uint16 version, and
/// a zlib stream of uint32 flags, the name with its ending 0 (version 4), uint64 vertices, uint64 triangles, positions,
/// normals, uvs, colours, uint32 indices; at the end of the file the meshes' offsets (uint64, in version 3 uint32) and
/// their number (uint32).
TriangleMesh load_serialized(const std::filesystem::path& file, int shape_index, const MeshFileOptions& options);
/// The same for a seekable stream; `file` is its name in messages.
TriangleMesh parse_serialized(std::istream& stream, const std::string& file, int shape_index,
                              const MeshFileOptions& options);

}  // namespace gradslc
