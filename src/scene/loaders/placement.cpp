#include "scene/loaders/placement.h"

namespace gradslc {

void flip_sides(TriangleMesh& mesh) {
  for (Normal3& normal : mesh.normals) normal = -normal;
  mesh.flip_normals = !mesh.flip_normals;
}

void place(TriangleMesh& mesh, const Transform& to_world, bool flip) {
  for (Point3& position : mesh.positions) position = to_world.apply(position);
  for (Normal3& normal : mesh.normals) normal = to_world.apply(normal);
  if (flip) flip_sides(mesh);
  if (to_world.determinant() < 0) mesh.flip_normals = !mesh.flip_normals;
}

}  // namespace gradslc
