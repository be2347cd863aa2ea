#include "support/render/scenes.h"

#include <fmt/format.h>

#include <numbers>
#include <string>
#include <utility>

#include "materials/plugins.h"
#include "scene/loaders/loader.h"

namespace gradslc {
namespace {

void append_quad(TriangleMesh& mesh, Point3 corner, Vec3 u, Vec3 v) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Point3 p : {corner, corner + u, corner + u + v, corner + v}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

constexpr const char* k_open_furnace = R"(
<scene version="3.0.0">
  <sensor type="perspective">
    <float name="fov" value="20"/>
    <transform name="to_world"><lookat origin="0, 5, 0" target="0, 0, 0" up="0, 0, 1"/></transform>
  </sensor>
  <shape type="rectangle">
    <transform name="to_world"><scale value="3"/><rotate x="1" angle="-90"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="90"/><translate y="-1"/></transform>
    <emitter type="area"><rgb name="radiance" value="40"/></emitter>
  </shape>
  <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
</scene>)";

constexpr const char* k_glossy_box = R"(
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="-90"/><translate y="-1"/></transform>
    <bsdf type="roughplastic">
      <string name="distribution" value="ggx"/> <float name="alpha" value="0.25"/>
      <boolean name="nonlinear" value="true"/> <rgb name="diffuse_reflectance" value="0.5, 0.4, 0.3"/>
    </bsdf>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate y="1" angle="180"/><translate z="1"/></transform>
    <bsdf type="roughconductor">
      <float name="alpha" value="0.2"/>
      <rgb name="eta" value="0.2, 0.9, 1.1"/> <rgb name="k" value="3.9, 2.5, 2.1"/>
    </bsdf>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate y="1" angle="90"/><translate x="-1"/></transform>
    <bsdf type="twosided">
      <bsdf type="roughplastic">
        <string name="distribution" value="ggx"/> <float name="alpha" value="0.05"/>
        <rgb name="diffuse_reflectance" value="0.7, 0.1, 0.1"/>
      </bsdf>
    </bsdf>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate y="1" angle="-90"/><translate x="1"/></transform>
    <bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.1, 0.6, 0.1"/></bsdf>
  </shape>
  <shape type="cube">
    <transform name="to_world">
      <scale value="0.3"/><rotate y="1" angle="30"/><translate x="-0.45" y="-0.69" z="0.2"/>
    </transform>
    <bsdf type="roughdielectric"><float name="alpha" value="0.3"/></bsdf>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><scale value="0.35"/><rotate y="1" angle="200"/><translate x="0.55" y="-0.4" z="-0.3"/></transform>
    <bsdf type="thindielectric"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><scale value="0.3"/><rotate y="1" angle="150"/><translate x="0.5" y="0.4" z="0"/></transform>
    <bsdf type="mask">
      <float name="opacity" value="0.6"/>
      <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.3, 0.8"/></bsdf></bsdf>
    </bsdf>
  </shape>)";

constexpr const char* k_partitioned_box = R"(
  <sensor type="perspective">
    <float name="fov" value="42"/>
    <transform name="to_world"><lookat origin="0, 0, -3.6" target="0, 0, 0" up="0, 1, 0"/></transform>
  </sensor>
  <bsdf type="diffuse" id="white"><rgb name="reflectance" value="0.7"/></bsdf>
  <bsdf type="diffuse" id="red"><rgb name="reflectance" value="0.7, 0.1, 0.1"/></bsdf>
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="-90"/><translate y="-1"/></transform> <ref id="white"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="90"/><translate y="1"/></transform> <ref id="white"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate y="1" angle="180"/><translate z="1"/></transform> <ref id="white"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate y="1" angle="90"/><translate x="-1"/></transform> <ref id="red"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate y="1" angle="-90"/><translate x="1"/></transform> <ref id="white"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><scale x="0.3" y="0.4"/><rotate y="1" angle="200"/><translate x="0.6" y="-0.5" z="0.7"/></transform>
    <bsdf type="conductor"><string name="material" value="none"/></bsdf>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><scale x="0.3" y="0.4"/><rotate x="1" angle="90"/><translate x="-0.6" y="0.98"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
    <emitter type="area"><rgb name="radiance" value="10, 8, 5"/></emitter>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><scale x="1.1" y="0.99"/><rotate y="1" angle="-60"/><translate x="0.1"/></transform>
    <ref id="partition"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><scale value="0.4"/><rotate x="1" angle="85"/><translate x="-0.55" y="0.5" z="-0.4"/></transform>
    <ref id="partition"/>
  </shape>)";

constexpr const char* k_ceiling = R"(
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="90"/><translate y="1"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.7"/></bsdf>
  </shape>)";

std::string lights_of(GlossyLight light) {
  switch (light) {
    case GlossyLight::lamp:
      return std::string(k_ceiling) + R"(
        <shape type="rectangle">
          <transform name="to_world"><scale value="0.3"/><rotate x="1" angle="90"/><translate y="0.98"/></transform>
          <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
          <emitter type="area"><rgb name="radiance" value="10, 8, 5"/></emitter>
        </shape>)";
    case GlossyLight::sky:
      return R"(
        <emitter type="constant"><rgb name="radiance" value="0.5, 0.7, 1"/></emitter>
        <emitter type="directional">
          <vector name="direction" x="0.3" y="-1" z="0.2"/> <rgb name="irradiance" value="2, 1.8, 1.5"/>
        </emitter>)";
    case GlossyLight::points:
      return std::string(k_ceiling) + R"(
        <emitter type="point">
          <point name="position" x="-0.3" y="0.7" z="-0.5"/> <rgb name="intensity" value="0.8, 0.7, 0.6"/>
        </emitter>
        <emitter type="spot">
          <transform name="to_world"><lookat origin="0.3, 0.8, -0.6" target="0, -1, 0.3" up="0, 0, 1"/></transform>
          <rgb name="intensity" value="2, 2, 3"/> <float name="cutoff_angle" value="35"/>
        </emitter>)";
  }
  return {};
}

/// Gives the corners of a quad normals that lean away from its middle.
void bend_normals(TriangleMesh& mesh, Vec3 u, Vec3 v) {
  constexpr float k_lean = 0.6f;
  const Vec3 n = normalize(cross(u, v)), s = k_lean * normalize(u), t = k_lean * normalize(v);
  for (const Vec3 lean : {-s - t, s - t, s + t, t - s}) mesh.normals.push_back(as_normal(normalize(n + lean)));
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

Scene open_furnace(Resolution resolution) {
  return Scene(
      load_scene_text(k_open_furnace, "open_furnace.xml", {.width = resolution.width, .height = resolution.height}));
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
    if (options.bent_normals) bend_normals(d.meshes.back(), u, v);
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
  if (options.glass_lamp) {
    d.meshes.push_back(outward_box(scaled({-0.5f, 0.5f, -0.5f}, s), scaled({0.5f, 0.99f, 0.5f}, s), 5));
    d.materials.push_back(make_rough_dielectric(MicrofacetType::ggx, 0.4f, 1.5f));
  }
  d.camera = camera_at(resolution, scaled({0, 0, -3.6f}, s), scaled({0, 0, 0}, s), 42);
  return Scene(std::move(d));
}

Scene partitioned_box(Resolution resolution, const std::string& partition) {
  std::string bsdf = partition;
  bsdf.insert(bsdf.find('>'), R"( id="partition")");
  const std::string text = "<scene version=\"3.0.0\">" + bsdf + k_partitioned_box + "</scene>";
  return Scene(load_scene_text(text, "partitioned_box.xml", {.width = resolution.width, .height = resolution.height}));
}

Scene glossy_box(Resolution resolution, GlossyLight light, float scale) {
  const std::string sensor = fmt::format(R"(<sensor type="perspective"><float name="fov" value="42"/>
    <transform name="to_world"><lookat origin="0, 0, {}" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>)",
                                         -3.6 * static_cast<double>(scale));
  const std::string text = "<scene version=\"3.0.0\">" + sensor + k_glossy_box + lights_of(light) + "</scene>";
  SceneDescription d =
      load_scene_text(text, "glossy_box.xml", {.width = resolution.width, .height = resolution.height});
  TriangleMesh board = quad({-0.2f, 0.1f, 0.5f}, {0.6f, 0, 0.1f}, {0, 0.6f, 0.2f}, 0);
  board.material = static_cast<std::uint32_t>(d.materials.size());
  d.materials.push_back(diffuse_material(Rgb(0.8f)));
  if (!d.material_names.empty()) d.material_names.push_back({"board", "twosided diffuse"});
  for (const Vec3 n : {Vec3{-0.9f, 0, -1}, Vec3{0.9f, 0.4f, -1}, Vec3{0.5f, 0.9f, -1}, Vec3{-0.5f, 0.5f, -1}})
    board.normals.push_back(as_normal(normalize(n)));
  d.meshes.push_back(board);
  for (TriangleMesh& mesh : d.meshes)
    for (Point3& position : mesh.positions) position = scaled(position, scale);
  return Scene(std::move(d));
}

}  // namespace gradslc
