#include "experiments/scene_hash.h"

#include <bit>
#include <span>

#include "experiments/sha256.h"
#include "scene/scene.h"

namespace gradslc {
namespace {

/// Values that have no padding bytes.
template <class T>
void add_values(Sha256& hash, const T* values, std::size_t count) {
  static_assert(std::has_unique_object_representations_v<T> || sizeof(T) % sizeof(float) == 0);
  hash.add_number(count);
  hash.add(std::as_bytes(std::span(values, count)));
}
template <class T>
void add_values(Sha256& hash, const std::vector<T>& values) {
  add_values(hash, values.data(), values.size());
}

void add_text(Sha256& hash, const std::string& text) {
  hash.add_number(text.size());
  hash.add(text);
}

void add_mesh(Sha256& hash, const TriangleMesh& mesh) {
  add_values(hash, mesh.positions);
  add_values(hash, mesh.normals);
  add_values(hash, mesh.uvs);
  add_values(hash, mesh.triangles);
  hash.add_number(mesh.flip_normals);
  hash.add_number(mesh.material);
  hash.add_number(static_cast<std::uint32_t>(mesh.area_light));
}

void add_camera(Sha256& hash, const PerspectiveCamera& camera) {
  const Resolution resolution = camera.resolution();
  hash.add_number(static_cast<std::uint64_t>(resolution.width));
  hash.add_number(static_cast<std::uint64_t>(resolution.height));
  const auto width = static_cast<float>(resolution.width), height = static_cast<float>(resolution.height);
  for (const Vec2 corner : {Vec2{0, 0}, Vec2{width, 0}, Vec2{0, height}, Vec2{width, height}}) {
    const Ray ray = camera.generate_ray(corner);
    add_values(hash, &ray.origin, 1);
    add_values(hash, &ray.direction, 1);
  }
  if (!camera.has_lens()) return;
  hash.add_number(std::bit_cast<std::uint32_t>(camera.lens().radius));
  hash.add_number(std::bit_cast<std::uint32_t>(camera.lens().focus_distance));
}

}  // namespace

std::string scene_hash(const Scene& scene) {
  Sha256 hash;
  for (const std::filesystem::path& file : scene.files()) add_text(hash, sha256_of_file(file));
  hash.add_number(scene.meshes().size());
  for (const TriangleMesh& mesh : scene.meshes()) add_mesh(hash, mesh);
  const Rgb power = scene.emitters().power();
  add_values(hash, &power, 1);
  add_camera(hash, scene.camera());
  return hash.finish();
}

}  // namespace gradslc
