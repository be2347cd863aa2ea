#include "experiments/scene_hash.h"

#include <bit>
#include <span>

#include "experiments/sha256.h"
#include "scene/scene.h"

namespace gradslc {
namespace {

constexpr int k_texture_grid = 64;  // probes of a material per axis of the unit square

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

void add_material(Sha256& hash, const Material& material) {
  add_text(hash, material.name);
  hash.add_number(material.kind.index());
  hash.add_number(material.two_sided);
  std::vector<Rgb> albedos;
  for (int v = 0; v < k_texture_grid; ++v) {
    for (int u = 0; u < k_texture_grid; ++u) {
      const Vec2 uv{(static_cast<float>(u) + 0.5f) / k_texture_grid, (static_cast<float>(v) + 0.5f) / k_texture_grid};
      albedos.push_back(material.resolve(uv).albedo());
    }
  }
  add_values(hash, albedos);
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

std::string scene_hash(const Scene& scene, const std::filesystem::path& file) {
  Sha256 hash;
  add_text(hash, sha256_of_file(file));
  hash.add_number(scene.meshes().size());
  for (const TriangleMesh& mesh : scene.meshes()) add_mesh(hash, mesh);
  hash.add_number(scene.materials().size());
  for (const Material& material : scene.materials()) add_material(hash, material);
  const Rgb power = scene.emitters().power();
  add_values(hash, &power, 1);
  add_camera(hash, scene.camera());
  return hash.finish();
}

}  // namespace gradslc
