#pragma once

#include "scene/loaders/transform.h"
#include "scene/mesh.h"

namespace gradslc {

/// Turns shading and geometric normals to the other side.
void flip_sides(TriangleMesh& mesh);

/// Moves a mesh. Normals go by the inverse transpose, so a mirroring map keeps their side although it turns the winding
/// round. `flip` turns them to the other side.
void place(TriangleMesh& mesh, const Transform& to_world, bool flip = false);

}  // namespace gradslc
