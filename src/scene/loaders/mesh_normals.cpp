#include "scene/loaders/mesh_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

namespace gradslc {
namespace {

using VertexTriple = std::array<std::uint32_t, 3>;

/// Any length; zero where the triangle has no area. In double, so that it does not vanish for small triangles.
std::array<double, 3> edge_cross(const TriangleMesh& mesh, const VertexTriple& t) {
  const Point3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
  const double ab[3] = {double{b.x} - a.x, double{b.y} - a.y, double{b.z} - a.z};
  const double ac[3] = {double{c.x} - a.x, double{c.y} - a.y, double{c.z} - a.z};
  return {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]};
}

/// Unit; zero where the triangle has no area.
Vec3 unit_normal(const TriangleMesh& mesh, const VertexTriple& t) {
  const auto [x, y, z] = edge_cross(mesh, t);
  const double length = std::sqrt(x * x + y * y + z * z);
  if (!(length > 0)) return {};
  return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

/// Between edges that are not zero.
float angle_between(Vec3 a, Vec3 b) {
  a = normalize(a), b = normalize(b);
  return std::atan2(length(cross(a, b)), dot(a, b));
}

/// A corner of a triangle, to be sorted by what it shares with others.
struct Corner {
  Point3 position;
  Vec2 uv;
  std::uint32_t triangle;
  std::uint32_t corner;  // 0, 1, 2
  auto place() const { return std::tie(position.x, position.y, position.z, uv.x, uv.y); }
};

std::vector<Corner> sorted_corners(const TriangleMesh& mesh) {
  std::vector<Corner> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = mesh.triangles[triangle][corner];
      corners.push_back({mesh.positions[vertex], mesh.uvs.empty() ? Vec2() : mesh.uvs[vertex], triangle, corner});
    }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return a.place() < b.place(); });
  return corners;
}

}  // namespace

void compute_normals(TriangleMesh& mesh) {
  std::vector<Vec3> sums(mesh.positions.size());
  for (const VertexTriple& triangle : mesh.triangles) {
    const Vec3 normal = unit_normal(mesh, triangle);
    if (normal == Vec3()) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 corner = mesh.positions[triangle[i]];
      const float angle =
          angle_between(mesh.positions[triangle[(i + 1) % 3]] - corner, mesh.positions[triangle[(i + 2) % 3]] - corner);
      sums[triangle[i]] = sums[triangle[i]] + angle * normal;
    }
  }
  mesh.normals.clear();
  mesh.normals.reserve(sums.size());
  for (const Vec3 sum : sums) mesh.normals.push_back(as_normal(length_squared(sum) > 0 ? normalize(sum) : Vec3()));
}

void compute_creased_normals(TriangleMesh& mesh, double max_angle) {
  const auto min_cosine = static_cast<float>(std::cos(max_angle * std::numbers::pi / 180));
  std::vector<Vec3> normals;
  normals.reserve(mesh.triangles.size());
  for (const VertexTriple& triangle : mesh.triangles) normals.push_back(unit_normal(mesh, triangle));

  const std::vector<Corner> corners = sorted_corners(mesh);
  TriangleMesh split;
  std::vector<Vec3> leaders;  // of the groups at the present place: the normal of their first triangle
  std::uint32_t first = 0;    // vertex of the first group
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner& corner = corners[i];
    if (i == 0 || corners[i - 1].place() != corner.place()) {
      leaders.clear();
      first = static_cast<std::uint32_t>(split.positions.size());
    }
    const Vec3 normal = normals[corner.triangle];
    const auto leader = std::find_if(leaders.begin(), leaders.end(), [&](Vec3 candidate) {
      return candidate == normal || dot(candidate, normal) > min_cosine;
    });
    const auto group = static_cast<std::uint32_t>(leader - leaders.begin());
    if (leader == leaders.end()) {
      leaders.push_back(normal);
      split.positions.push_back(corner.position);
      if (!mesh.uvs.empty()) split.uvs.push_back(corner.uv);
    }
    mesh.triangles[corner.triangle][corner.corner] = first + group;
  }
  mesh.positions = std::move(split.positions);
  mesh.uvs = std::move(split.uvs);
  compute_normals(mesh);
}

void wind_by_normals(TriangleMesh& mesh) {
  for (VertexTriple& triangle : mesh.triangles) {
    const auto& [i, j, k] = triangle;
    const Vec3 sum = as_vec(mesh.normals[i]) + as_vec(mesh.normals[j]) + as_vec(mesh.normals[k]);
    const auto [x, y, z] = edge_cross(mesh, triangle);
    if (x * sum.x + y * sum.y + z * sum.z < 0) std::swap(triangle[1], triangle[2]);
  }
}

void finish_normals(TriangleMesh& mesh, const MeshFileOptions& options) {
  if (options.face_normals) {
    mesh.normals.clear();
  } else if (options.max_smooth_angle) {
    compute_creased_normals(mesh, *options.max_smooth_angle);
  } else if (mesh.normals.empty()) {
    compute_normals(mesh);
  } else {
    wind_by_normals(mesh);
  }
}

}  // namespace gradslc
