#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/loaders/mitsuba_shapes.h"
#include "scene/loaders/transform.h"
#include "scene/mesh.h"

namespace gradslc {

/// The meshes of a scene while its file is read: what is to be made, and where it is to stand. Everything is made at
/// the end, on all threads.
class MeshList {
 public:
  struct Planned {
    ShapePlan shape;
    std::string name;
    std::uint32_t material = 0;
    std::int32_t area_light = -1;
  };
  /// Its number, for what follows. It is seen only where it is placed.
  std::size_t add(Planned mesh);
  const std::string& name(std::size_t mesh) const { return planned_[mesh].name; }
  /// As it is; once.
  void place(std::size_t mesh);
  /// A copy, moved.
  void place_copy(std::size_t mesh, const Transform& to_world, std::string name);

  /// What has been placed, in the order in which it was. Throws the Error of the first mesh, in the order of adding,
  /// that cannot be made, and one (input, `file`) where copies have more than 2^30 triangles.
  std::vector<TriangleMesh> make(const std::string& file) const;

 private:
  struct Placed {
    std::size_t mesh;
    std::optional<Transform> to_world;  // none: the mesh itself
    std::string name;
  };
  std::vector<TriangleMesh> make_planned() const;
  void check_size(const std::vector<TriangleMesh>& made, const std::string& file) const;

  std::vector<Planned> planned_;
  std::vector<Placed> placed_;
};

}  // namespace gradslc
