#pragma once

#include "scene/mesh.h"

namespace gradslc {

/// The square [-1,1]^2 at z = 0, flat, normal +z; uvs from (0,0) at (-1,-1) to (1,1).
TriangleMesh unit_rectangle();
/// The surface of [-1,1]^3, flat, normals outwards. As Mitsuba's cube it maps each face onto [0,1]^2.
TriangleMesh unit_cube();

}  // namespace gradslc
