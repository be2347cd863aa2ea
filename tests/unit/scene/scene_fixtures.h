#pragma once
// Small scenes and random numbers for the tests of this room.

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "materials/plugins.h"
#include "scene/loaders/transform.h"
#include "scene/scene.h"

namespace gradslc::test {

/// Uniform numbers in [0,1) with a fixed seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return std::generate_canonical<double, 53>(engine_); }
  float get1() { return std::min(static_cast<float>(uniform()), k_one_minus_epsilon); }
  Vec2 get2() {
    const float x = get1();
    const float y = get1();
    return {x, y};
  }

 private:
  std::mt19937_64 engine_;
};

/// A parallelogram with corner `corner` and edges `u`, `v`; its normal is u x v.
inline TriangleMesh parallelogram(Point3 corner, Vec3 u, Vec3 v) {
  TriangleMesh mesh;
  mesh.name = "parallelogram";
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {2, 3, 0}};
  return mesh;
}

/// A scene of meshes with one grey material.
inline SceneDescription describe(std::vector<TriangleMesh> meshes, std::vector<AreaLight> lights = {}) {
  SceneDescription description;
  description.meshes = std::move(meshes);
  const MaterialPtr grey = make_diffuse(Texture(Rgb(0.5f)));
  description.materials = {make_two_sided(grey, grey)};
  description.area_lights = std::move(lights);
  return description;
}

/// The inner sides of the box [-1,1]^3, one mesh per wall, normals inwards.
inline std::vector<TriangleMesh> room() {
  return {parallelogram({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}), parallelogram({1, -1, -1}, {0, 0, 2}, {0, 2, 0}),
          parallelogram({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}), parallelogram({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}),
          parallelogram({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}), parallelogram({-1, -1, 1}, {0, 2, 0}, {2, 0, 0})};
}

/// A box of half edges `half` around `centre` turned about y, one mesh, normals outwards.
inline TriangleMesh block(Point3 centre, Vec3 half, double degrees) {
  const Transform place = Transform::translation(centre.x, centre.y, centre.z) * Transform::rotation(0, 1, 0, degrees) *
                          Transform::scaling(half.x, half.y, half.z);
  TriangleMesh mesh;
  mesh.name = "block";
  for (TriangleMesh& wall : room()) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Point3 p : wall.positions) mesh.positions.push_back(place.apply(p));
    for (const auto& [i, j, k] : wall.triangles) mesh.triangles.push_back({first + i, first + k, first + j});
  }
  return mesh;
}

inline void transform(std::vector<TriangleMesh>& meshes, const Transform& map) {
  for (TriangleMesh& mesh : meshes)
    for (Point3& p : mesh.positions) p = map.apply(p);
}

}  // namespace gradslc::test
