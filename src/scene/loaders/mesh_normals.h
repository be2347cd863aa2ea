#pragma once

#include "scene/loaders/mesh_file.h"
#include "scene/mesh.h"

namespace gradslc {

/// Normals of a mesh as it comes from a file, positions and normals in world space, with what the options ask for:
/// none (face_normals), new ones with creases (max_smooth_angle), the file's own, or smooth ones where it has none.
/// The file's own choose the sides of triangles (wind_by_normals).
/// All indices must be in range.
void finish_normals(TriangleMesh& mesh, const MeshFileOptions& options);

/// Vertex normals: the mean of the adjoining triangles' normals by their angles at the vertex (Thuermer and Wuethrich
/// 1998, "Computing Vertex Normals from Polygonal Facets"); zero where they cancel.
void compute_normals(TriangleMesh& mesh);

/// Splits and joins vertices so that triangles that meet in a position with the same uv share a vertex there where
/// their normals differ by less than `max_angle` degrees, then computes normals: Mitsuba 0.6's maxSmoothAngle. As
/// there, triangles gather greedily, in the order of the file, around the first one that is not yet in a group.
void compute_creased_normals(TriangleMesh& mesh, double max_angle);

/// Winds triangles the other way where the sum of their vertex normals faces away from their winding: Mitsuba lets
/// vertex normals choose the side of the surface.
void wind_by_normals(TriangleMesh& mesh);

}  // namespace gradslc
