#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/cli/commands.h"
#include "scene/inventory.h"
#include "scene/loaders/loader.h"

namespace gradslc {
namespace {

using nlohmann::json;

struct InfoArguments {
  std::string scene;
  bool permissive = false, print_json = false;
};

json as_json(Point3 p) { return {p.x, p.y, p.z}; }
json as_json(Rgb c) { return {c.r, c.g, c.b}; }

json as_json(const SceneInventory& s) {
  return {{"width", s.resolution.width},
          {"height", s.resolution.height},
          {"camera_position", as_json(s.camera_position)},
          {"meshes", s.meshes},
          {"triangles", s.triangles},
          {"bounds", {{"lower", as_json(s.bounds.lower)}, {"upper", as_json(s.bounds.upper)}}},
          {"materials", s.materials},
          {"textures", s.textures},
          {"lights", s.lights},
          {"emissive_triangles", s.emissive_triangles},
          {"emitted_power", as_json(s.emitted_power)},
          {"delta_light_on_delta_lobes", s.delta_light_on_delta_lobes},
          {"geometry_bytes", s.geometry_bytes},
          {"texture_bytes", s.texture_bytes},
          {"light_bytes", s.light_bytes},
          {"notes", s.notes}};
}

/// "2 diffuse, 1 twosided plastic"
std::string counted(const std::map<std::string, int>& counts) {
  std::vector<std::string> texts;
  texts.reserve(counts.size());
  for (const auto& [name, count] : counts) texts.push_back(fmt::format("{} {}", count, name));
  return texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, ", "));
}

double megabytes(std::size_t bytes) { return static_cast<double>(bytes) * 1e-6; }

void print_text(const SceneInventory& s) {
  const Point3 camera = s.camera_position, lower = s.bounds.lower, upper = s.bounds.upper;
  const Rgb power = s.emitted_power;
  fmt::print("image      {} x {} pixels\n", s.resolution.width, s.resolution.height);
  fmt::print("camera     at ({:g}, {:g}, {:g})\n", camera.x, camera.y, camera.z);
  fmt::print("geometry   {} meshes, {} triangles\n", s.meshes, s.triangles);
  if (!s.bounds.empty())
    fmt::print("bounds     ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})\n", lower.x, lower.y, lower.z, upper.x, upper.y,
               upper.z);
  fmt::print("materials  {}\n", counted(s.materials));
  fmt::print("textures   {}\n", s.textures);
  fmt::print("lights     {}; {} emissive triangles, power ({:g}, {:g}, {:g})\n", counted(s.lights),
             s.emissive_triangles, power.r, power.g, power.b);
  fmt::print("memory     {:.1f} MB: geometry {:.1f}, textures {:.1f}, lights {:.1f}\n",
             megabytes(s.geometry_bytes + s.texture_bytes + s.light_bytes), megabytes(s.geometry_bytes),
             megabytes(s.texture_bytes), megabytes(s.light_bytes));
  if (s.delta_light_on_delta_lobes)
    fmt::print(
        "note       light of point, spot or directional emitters that a mirror or glass scatters first is in no "
        "method's image\n");
  for (const std::string& note : s.notes) fmt::print("note       {}\n", note);
}

int info(const InfoArguments& arguments) {
  const SceneInventory inventory =
      take_inventory(Scene(load_scene(arguments.scene, {.permissive = arguments.permissive})));
  if (arguments.print_json)
    fmt::print("{}\n", as_json(inventory).dump(2));
  else
    print_text(inventory);
  return k_done;
}

}  // namespace

Command info_command(CLI::App& parent) {
  const auto arguments = std::make_shared<InfoArguments>();
  CLI::App& app = *parent.add_subcommand("info", "Says what a scene holds, and what in its file has no effect");
  app.add_option("SCENE", arguments->scene, "Mitsuba scene file (.xml)")->required();
  app.add_flag("--permissive", arguments->permissive, "Note what is not recognised instead of refusing the scene");
  app.add_flag("--json", arguments->print_json, "Print JSON");
  app.footer("Example:\n  gradslc info scenes/cornell-box/scene.xml");
  return {&app, [arguments] { return info(*arguments); }};
}

}  // namespace gradslc
