#pragma once
// Small scenes for tests, built in memory.

#include <string>

#include "scene/scene.h"

namespace gradslc {

/// A parallelogram with corner `corner` and edges `u`, `v`; its normal is u x v.
TriangleMesh quad(Point3 corner, Vec3 u, Vec3 v, std::uint32_t material);
/// An axis-aligned box from `lower` to `upper`, normals inwards.
TriangleMesh inward_box(Point3 lower, Point3 upper, std::uint32_t material);
/// The same with normals outwards.
TriangleMesh outward_box(Point3 lower, Point3 upper, std::uint32_t material);

/// Both are two-sided.
MaterialPtr diffuse_material(Rgb albedo);
MaterialPtr mirror_material(Rgb reflectance = Rgb(1.0f));

/// A camera at `position` that looks at `target`; `fov` in degrees, horizontal.
PerspectiveCamera camera_at(Resolution resolution, Point3 position, Point3 target, float fov);

/// A closed cube of side 2 seen from inside; all walls are Lambertian with `albedo` and emit radiance 1:
/// a path of exactly D edges brings albedo^(D-1) everywhere.
Scene closed_furnace(Rgb albedo, Resolution resolution, float scale = 1);

/// A Lambertian floor of albedo 0.5 under a sky of radiance 1, which is 0.5 bright everywhere, and a lamp of most of
/// the emitters' power that shines away from it.
Scene open_furnace(Resolution resolution);

/// A box of side 2 with coloured walls, a lamp under its ceiling and a block; with `mirror`, the block is a mirror that
/// throws a caustic, and the back wall is a mirror, too. With `bent_normals`, the walls' shading normals lean outwards
/// at their corners by some 40 degrees.
struct TestBox {
  bool mirror = false;
  bool bent_normals = false;
  bool glass_lamp = false;  ///< the lamp stands in a box of rough glass
  float scale = 1;
  float wall_albedo = 0.7f;
};
Scene test_box(Resolution resolution, const TestBox& options = {});

/// A box of the same size that a slanting partition divides: the lamp is in its left part, half of it over a second
/// sheet of the same material, and a mirror stands behind the partition. `partition`: the sheets' <bsdf>, whose tag
/// does not close itself.
Scene partitioned_box(Resolution resolution, const std::string& partition);

/// A box of the same size with every kind of lobe: rough and smooth plastic, rough and smooth metal, rough glass, a
/// pane, a mask, and a board whose shading normals are far off its geometric one.
enum class GlossyLight : std::uint8_t {
  lamp,   ///< an area light under the ceiling
  sky,    ///< an environment above the open box, and parallel light
  points  ///< a point and a spot light
};
/// With `scale`, points keep their intensity, and so light less.
Scene glossy_box(Resolution resolution, GlossyLight light = GlossyLight::lamp, float scale = 1);

}  // namespace gradslc
