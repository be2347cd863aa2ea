#include "support/render/scenes.h"

#include <numbers>

#include "materials/plugins.h"

namespace gradslc {
namespace {

void append_quad(TriangleMesh& mesh, Point3 corner, Vec3 u, Vec3 v) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Point3 p : {corner, corner + u, corner + u + v, corner + v}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

Point3 scaled(Point3 p, float scale) { return {p.x * scale, p.y * scale, p.z * scale}; }

}  // namespace

TriangleMesh quad(Point3 corner, Vec3 u, Vec3 v, std::uint32_t material) {
  TriangleMesh mesh;
  append_quad(mesh, corner, u, v);
  mesh.material = material;
  return mesh;
}

TriangleMesh inward_box(Point3 lower, Point3 upper, std::uint32_t material) {
  const Vec3 d = upper - lower;
  const Vec3 x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
  TriangleMesh mesh;
  append_quad(mesh, lower, x, y), append_quad(mesh, lower, y, z), append_quad(mesh, lower, z, x);
  append_quad(mesh, upper, -y, -x), append_quad(mesh, upper, -z, -y), append_quad(mesh, upper, -x, -z);
  mesh.material = material;
  return mesh;
}

TriangleMesh outward_box(Point3 lower, Point3 upper, std::uint32_t material) {
  TriangleMesh mesh = inward_box(lower, upper, material);
  mesh.flip_normals = true;
  return mesh;
}

MaterialPtr diffuse_material(Rgb albedo) {
  const MaterialPtr diffuse = make_diffuse(Texture(albedo));
  return make_two_sided(diffuse, diffuse);
}

MaterialPtr mirror_material(Rgb reflectance) {
  const MaterialPtr mirror = make_mirror(Texture(reflectance));
  return make_two_sided(mirror, mirror);
}

PerspectiveCamera camera_at(Resolution resolution, Point3 position, Point3 target, float fov) {
  const Vec3 forward = normalize(target - position);
  const Vec3 world_up = std::abs(forward.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 right = normalize(cross(forward, world_up));
  const float tan_half = std::tan(fov * std::numbers::pi_v<float> / 360);
  const float aspect = static_cast<float>(resolution.height) / static_cast<float>(resolution.width);
  return {resolution, position, forward, right, cross(right, forward), tan_half, tan_half * aspect};
}

Scene closed_furnace(Rgb albedo, Resolution resolution, float scale) {
  SceneDescription description;
  description.materials = {diffuse_material(albedo)};
  description.area_lights = {{Rgb(1)}};
  TriangleMesh walls = inward_box(scaled({-1, -1, -1}, scale), scaled({1, 1, 1}, scale), 0);
  walls.area_light = 0;
  description.meshes = {walls};
  description.camera = camera_at(resolution, scaled({0.2f, 0.1f, -0.3f}, scale), scaled({1, 0.5f, 1}, scale), 70);
  return Scene(std::move(description));
}

Scene test_box(Resolution resolution, const TestBox& options) {
  const float s = options.scale, a = options.wall_albedo;
  SceneDescription d;
  const std::uint32_t white = 0, red = 1, green = 2, black = 3, mirror = 4;
  d.materials = {diffuse_material(Rgb(a)), diffuse_material(Rgb(a, 0.1f * a, 0.1f * a)),
                 diffuse_material(Rgb(0.1f * a, a, 0.1f * a)), diffuse_material(Rgb(0.0f)), mirror_material(Rgb(0.9f))};
  d.area_lights = {{Rgb(10, 8, 5)}};
  const auto wall = [&](Point3 corner, Vec3 u, Vec3 v, std::uint32_t material) {
    d.meshes.push_back(quad(scaled(corner, s), s * u, s * v, material));
  };
  wall({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);                           // floor
  wall({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);                            // ceiling
  wall({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, options.mirror ? mirror : white);  // back
  wall({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, red);                             // left
  wall({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, green);                            // right
  d.meshes.push_back(
      outward_box(scaled({-0.6f, -1, 0.1f}, s), scaled({0, 0.1f, 0.6f}, s), options.mirror ? mirror : white));
  d.meshes.push_back(quad(scaled({-0.3f, 0.98f, -0.3f}, s), s * Vec3{0.6f, 0, 0}, s * Vec3{0, 0, 0.6f}, black));
  d.meshes.back().area_light = 0;
  d.camera = camera_at(resolution, scaled({0, 0, -3.6f}, s), scaled({0, 0, 0}, s), 42);
  return Scene(std::move(d));
}

}  // namespace gradslc
