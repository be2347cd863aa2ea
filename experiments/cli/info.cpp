#include <fmt/format.h>

#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "experiments/cli/commands.h"
#include "scene/loaders/loader.h"
#include "scene/scene.h"

namespace gradslc {
namespace {

using nlohmann::json;

struct InfoArguments {
  std::string scene;
  bool print_json = false;
};

json as_json(Point3 p) { return {p.x, p.y, p.z}; }
json as_json(Rgb c) { return {c.r, c.g, c.b}; }

json information(const Scene& scene) {
  json materials = json::array();
  for (const Material& material : scene.materials())
    materials.push_back({{"name", material.name}, {"two_sided", material.two_sided}});
  const Resolution resolution = scene.camera().resolution();
  return {{"width", resolution.width},
          {"height", resolution.height},
          {"camera_position", as_json(scene.camera().position())},
          {"meshes", scene.meshes().size()},
          {"triangles", scene.triangle_count()},
          {"materials", std::move(materials)},
          {"emitters", scene.emitters().size()},
          {"emitted_power", as_json(scene.emitters().power())},
          {"bounds", {{"lower", as_json(scene.bounds().lower)}, {"upper", as_json(scene.bounds().upper)}}},
          {"memory_bytes", scene.memory_bytes()},
          {"notes", scene.notes()}};
}

void print_text(const Scene& scene) {
  const Resolution resolution = scene.camera().resolution();
  const Point3 camera = scene.camera().position();
  const Bounds3 bounds = scene.bounds();
  const Rgb power = scene.emitters().power();
  fmt::print("image      {} x {} pixels\n", resolution.width, resolution.height);
  fmt::print("camera     at ({:g}, {:g}, {:g})\n", camera.x, camera.y, camera.z);
  fmt::print("geometry   {} meshes, {} triangles\n", scene.meshes().size(), scene.triangle_count());
  fmt::print("bounds     ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})\n", bounds.lower.x, bounds.lower.y, bounds.lower.z,
             bounds.upper.x, bounds.upper.y, bounds.upper.z);
  fmt::print("materials  {}\n", scene.materials().size());
  fmt::print("emitters   {} triangles, power ({:g}, {:g}, {:g})\n", scene.emitters().size(), power.r, power.g, power.b);
  fmt::print("memory     {:.1f} MB\n", static_cast<double>(scene.memory_bytes()) * 1e-6);
  for (const std::string& note : scene.notes()) fmt::print("note       {}\n", note);
}

int info(const InfoArguments& arguments) {
  const Scene scene(load_scene(arguments.scene));
  if (arguments.print_json)
    fmt::print("{}\n", information(scene).dump(2));
  else
    print_text(scene);
  return k_done;
}

}  // namespace

Command info_command(CLI::App& parent) {
  const auto arguments = std::make_shared<InfoArguments>();
  CLI::App& app = *parent.add_subcommand("info", "Says what a scene holds, and what in its file has no effect");
  app.add_option("SCENE", arguments->scene, "Mitsuba scene file (.xml)")->required();
  app.add_flag("--json", arguments->print_json, "Print JSON");
  app.footer("Example:\n  gradslc info scenes/cornell-box/scene.xml");
  return {&app, [arguments] { return info(*arguments); }};
}

}  // namespace gradslc
