#include "scene/loaders/quadrics.h"

#include <cmath>
#include <numbers>

#include "scene/triangle.h"

namespace gradslc {
namespace {

constexpr std::uint32_t k_segments = 256;          // around
constexpr std::uint32_t k_bands = k_segments / 2;  // from pole to pole

/// cos and sin of the angle of segment `i`; the last one is the first one exactly.
Vec2 on_circle(std::uint32_t i) {
  const double phi = 2 * std::numbers::pi * (i % k_segments) / k_segments;
  return {static_cast<float>(std::cos(phi)), static_cast<float>(std::sin(phi))};
}

float fraction(double numerator, std::uint32_t denominator) { return static_cast<float>(numerator / denominator); }

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [i, j, k] : mesh.triangles)
    sum += triangle_area(mesh.positions[i], mesh.positions[j], mesh.positions[k]);
  return sum;
}

void scale(TriangleMesh& mesh, double xy, double z) {
  for (Point3& p : mesh.positions)
    p = {static_cast<float>(xy * p.x), static_cast<float>(xy * p.y), static_cast<float>(z * p.z)};
}

void add_vertex(TriangleMesh& mesh, Vec3 position, Normal3 normal, Vec2 uv) {
  mesh.positions.push_back(Point3() + position);
  mesh.normals.push_back(normal);
  mesh.uvs.push_back(uv);
}

void add_ring(TriangleMesh& mesh, double theta, float v) {
  const auto sine = static_cast<float>(std::sin(theta)), cosine = static_cast<float>(std::cos(theta));
  for (std::uint32_t i = 0; i <= k_segments; ++i) {
    const auto [x, y] = on_circle(i);
    const Vec3 p{sine * x, sine * y, cosine};
    add_vertex(mesh, p, as_normal(p), {fraction(i, k_segments), v});
  }
}

/// A pole has no phi: each triangle has a vertex of its own there, with the u of its middle.
void add_pole(TriangleMesh& mesh, float z, float v) {
  for (std::uint32_t i = 0; i < k_segments; ++i)
    add_vertex(mesh, {0, 0, z}, {0, 0, z}, {fraction(i + 0.5, k_segments), v});
}

}  // namespace

TriangleMesh unit_sphere() {
  TriangleMesh mesh;
  add_pole(mesh, 1, 0);
  for (std::uint32_t band = 1; band < k_bands; ++band)
    add_ring(mesh, std::numbers::pi * band / k_bands, fraction(band, k_bands));
  const auto south = static_cast<std::uint32_t>(mesh.positions.size());
  add_pole(mesh, -1, 1);

  const auto ring = [](std::uint32_t band) { return k_segments + (band - 1) * (k_segments + 1); };
  for (std::uint32_t i = 0; i < k_segments; ++i) mesh.triangles.push_back({i, ring(1) + i, ring(1) + i + 1});
  for (std::uint32_t band = 1; band + 1 < k_bands; ++band)
    for (std::uint32_t i = 0; i < k_segments; ++i) {
      const std::uint32_t upper = ring(band) + i, lower = ring(band + 1) + i;
      mesh.triangles.push_back({upper, lower, lower + 1});
      mesh.triangles.push_back({upper, lower + 1, upper + 1});
    }
  for (std::uint32_t i = 0; i < k_segments; ++i)
    mesh.triangles.push_back({south + i, ring(k_bands - 1) + i + 1, ring(k_bands - 1) + i});

  const double radius = std::sqrt(4 * std::numbers::pi / area(mesh));
  scale(mesh, radius, radius);
  return mesh;
}

TriangleMesh unit_disk() {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= k_segments; ++i) {
    const auto [x, y] = on_circle(i);
    add_vertex(mesh, {x, y, 0}, {0, 0, 1}, {1, fraction(i, k_segments)});
  }
  for (std::uint32_t i = 0; i < k_segments; ++i) {
    mesh.triangles.push_back({static_cast<std::uint32_t>(mesh.positions.size()), i, i + 1});
    add_vertex(mesh, {0, 0, 0}, {0, 0, 1}, {0, fraction(i + 0.5, k_segments)});
  }
  mesh.normals.clear();  // flat
  scale(mesh, std::sqrt(std::numbers::pi / area(mesh)), 1);
  return mesh;
}

TriangleMesh unit_cylinder() {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= k_segments; ++i) {
    const auto [x, y] = on_circle(i);
    for (const float z : {0.0f, 1.0f}) add_vertex(mesh, {x, y, z}, {x, y, 0}, {fraction(i, k_segments), z});
  }
  for (std::uint32_t i = 0; i < 2 * k_segments; i += 2) {
    mesh.triangles.push_back({i, i + 2, i + 3});
    mesh.triangles.push_back({i, i + 3, i + 1});
  }
  scale(mesh, 2 * std::numbers::pi / area(mesh), 1);
  return mesh;
}

}  // namespace gradslc
