#pragma once

#include "scene/mesh.h"

namespace gradslc {

// Round shapes as triangles, in their own space. Area and silhouette are within 1e-4 of the round shape's, relative to
// its area and radius: the vertices stand a little outside, so that the area is right (up to float), and edges and
// faces a little inside. Neighbours share their positions exactly (no gaps). Normals are the round shape's. uvs as
// Mitsuba documents them.

/// The unit sphere around the origin, normals outwards; u = phi / 2 pi, v = theta / pi. 65,024 triangles.
TriangleMesh unit_sphere();
/// The unit disk at z = 0, flat, normal +z; u = r, v = phi / 2 pi. 256 triangles.
TriangleMesh unit_disk();
/// Radius 1 around the z axis from z = 0 to 1, without caps, normals outwards; u = phi / 2 pi, v = z. 512 triangles.
TriangleMesh unit_cylinder();

}  // namespace gradslc
