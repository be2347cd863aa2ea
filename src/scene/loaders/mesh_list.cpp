#include "scene/loaders/mesh_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "scene/loaders/placement.h"

namespace gradslc {
namespace {

constexpr std::size_t k_max_copied_triangles = std::size_t{1} << 30;  // about 150 GB in all

}  // namespace

std::size_t MeshList::add(Planned mesh) {
  planned_.push_back(std::move(mesh));
  return planned_.size() - 1;
}

void MeshList::place(std::size_t mesh) { placed_.push_back({mesh, std::nullopt, planned_[mesh].name}); }

void MeshList::place_copy(std::size_t mesh, const Transform& to_world, std::string name) {
  placed_.push_back({mesh, to_world, std::move(name)});
}

/// Largest files first, so that no thread is left alone with one at the end.
std::vector<TriangleMesh> MeshList::make_planned() const {
  std::vector<std::size_t> order(planned_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return planned_[a].shape.bytes > planned_[b].shape.bytes; });
  std::vector<TriangleMesh> made(planned_.size());
  std::vector<std::exception_ptr> errors(planned_.size());
  parallel_for(order.size(), 1, [&](std::size_t begin, std::size_t) {
    const std::size_t i = order[begin];
    try {
      made[i] = planned_[i].shape.make();
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  for (std::size_t i = 0; i < made.size(); ++i) {
    made[i].material = planned_[i].material;
    made[i].area_light = planned_[i].area_light;
  }
  return made;
}

void MeshList::check_size(const std::vector<TriangleMesh>& made, const std::string& file) const {
  std::size_t triangles = 0;
  for (const Placed& placed : placed_) {
    if (placed.to_world) triangles += made[placed.mesh].triangles.size();
    if (triangles > k_max_copied_triangles)
      throw_input_error(file, fmt::format("the instances have more than {} triangles; each instance is a copy here",
                                          k_max_copied_triangles));
  }
}

std::vector<TriangleMesh> MeshList::make(const std::string& file) const {
  std::vector<TriangleMesh> made = make_planned();
  check_size(made, file);
  std::vector<TriangleMesh> meshes(placed_.size());
  parallel_for(placed_.size(), 1, [&](std::size_t i, std::size_t) {
    const Placed& placed = placed_[i];
    if (placed.to_world) {
      meshes[i] = made[placed.mesh];
      gradslc::place(meshes[i], *placed.to_world);
    } else {
      meshes[i] = std::move(made[placed.mesh]);
    }
    meshes[i].name = placed.name;
  });
  return meshes;
}

}  // namespace gradslc
