#include "experiments/render.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <sstream>

#include "core/file.h"
#include "core/parallel.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/console.h"
#include "experiments/cli/output_path.h"
#include "experiments/components.h"
#include "experiments/config_override.h"
#include "experiments/method_plan.h"
#include "experiments/replay.h"
#include "experiments/report_images.h"
#include "scene/loaders/loader.h"
#include "scene/scene.h"

namespace gradslc {
namespace {

using nlohmann::json;

struct RenderArguments {
  std::string scene, method = "spt", components;
  std::filesystem::path output;
  std::optional<int> width, height;
  std::optional<double> seconds;
  int spp = 16, threads = 0, max_depth = RenderSettings{}.max_depth;
  std::int64_t seed = 1;
  std::string sampler;
  std::vector<std::string> overrides;
  float exposure = 0;
  std::optional<std::string> replay;
  bool permissive = false, parts = false, debug = false, features = false, print_json = false, quiet = false;
};

/// Reads --method, a name or a JSON object, with --set applied.
std::optional<MethodPlan> method_of(const RenderArguments& arguments, Problems& problems) {
  const std::string& text = arguments.method;
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  const bool is_object = begin != text.npos && text[begin] == '{';
  JsonDocument document =
      is_object
          ? JsonDocument::parse("--method", text)
          : JsonDocument::from_value("--method", arguments.overrides.empty() ? json(text) : json{{"integrator", text}});
  for (const std::string& assignment : arguments.overrides) apply_override(document, assignment);
  return read_method(document, "", all_registries(), problems);
}

Components components_of(const std::string& list) {
  if (list.empty()) return {};
  Components components{false, false, false};
  std::istringstream stream(list);
  for (std::string name; std::getline(stream, name, ',');)
    if (!include_component(components, name))
      throw_input_error("--components",
                        fmt::format("unknown component \"{}\"{}", name, suggestion(name, component_names())));
  return components;
}

RenderSettings settings_of(const RenderArguments& arguments) {
  RenderSettings settings;
  settings.seed = static_cast<std::uint64_t>(arguments.seed);
  settings.max_depth = arguments.max_depth;
  settings.components = components_of(arguments.components);
  if (arguments.sampler.empty()) return settings;
  std::vector<std::string> names;
  for (const SamplerEntry& entry : sampler_registry()) {
    names.emplace_back(entry.name);
    if (arguments.sampler != entry.name) continue;
    settings.sampler = entry.kind;
    return settings;
  }
  throw_input_error("--sampler",
                    fmt::format("unknown sampler \"{}\"{}", arguments.sampler, suggestion(arguments.sampler, names)));
}

bool writes_png(const std::filesystem::path& output) {
  if (output.extension() == ".png") return true;
  if (output.extension() == ".exr") return false;
  throw_input_error(output.string(), "must end in .exr or .png");
}

/// What JSON can hold of a measured value.
json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json summary(const RenderResult& result, const MethodPlan& method, const std::filesystem::path& output) {
  json mean = json::array();
  for (const double channel : channel_means(result.image)) mean.push_back(number(channel));
  return {{"file", output.string()},
          {"method", method.name},
          {"width", result.image.width()},
          {"height", result.image.height()},
          {"passes", result.passes},
          {"spp", result.passes},
          {"wall_seconds", result.wall_seconds},
          {"cpu_seconds", result.cpu_seconds},
          {"prepare_seconds", result.prepare_seconds},
          {"render_seconds", result.render_seconds},
          {"reconstruct_seconds", result.reconstruct_seconds},
          {"rays", result.statistics.rays},
          {"invalid_samples", result.film->invalid_samples()},
          {"biased", result.traits.biased},
          {"truncated", result.traits.truncated},
          {"one_set", result.traits.one_set},
          {"mean", std::move(mean)}};
}

std::string summary_line(const RenderResult& result, const std::filesystem::path& output) {
  return fmt::format("{}: {}x{}, {} passes in {:.2f} s ({:.2f} s CPU), {:.3g} million rays", output.string(),
                     result.image.width(), result.image.height(), result.passes, result.wall_seconds,
                     result.cpu_seconds, static_cast<double>(result.statistics.rays) * 1e-6);
}

/// The largest contribution to a film that has debug images: where, and what it came by.
struct Firefly {
  Pixel pixel;
  Largest largest;
};
std::optional<Firefly> largest_contribution(const Film& film) {
  if (!film.layers().debug) return std::nullopt;
  const DebugImage debug = film.debug();
  const std::optional<Pixel> pixel = pixel_of_largest_contribution(debug);
  if (!pixel) return std::nullopt;
  return Firefly{*pixel, debug[*pixel].contribution};
}
std::string replay_of(const Firefly& firefly) {
  return fmt::format("{},{},{}", firefly.pixel.x, firefly.pixel.y, firefly.largest.pass);
}
/// The part's name, or "" where it is not known.
std::string part_of(const Firefly& firefly) {
  const std::optional<Part> part = firefly.largest.part;
  return part ? k_part_names[static_cast<std::size_t>(*part)] : "";
}
json to_json(const Firefly& firefly) {
  return {{"luminance", number(double{firefly.largest.luminance})},
          {"part", part_of(firefly)},
          {"replay", replay_of(firefly)}};
}
std::string firefly_line(const Firefly& firefly) {
  const std::string part = part_of(firefly);
  return fmt::format("largest contribution: luminance {:.4g}{}; --replay {} instead of --debug shows its sample",
                     firefly.largest.luminance, part.empty() ? "" : fmt::format(" ({})", part), replay_of(firefly));
}

/// Which sample --replay asks for.
struct ReplayTarget {
  Pixel pixel;
  std::uint32_t pass;
};
ReplayTarget replay_target(const std::string& text) {
  std::array<std::uint32_t, 3> numbers{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto [rest, code] = std::from_chars(at, end, numbers[i]);
    const bool last = i + 1 == numbers.size();
    const bool fits = numbers[i] <= static_cast<std::uint32_t>(std::numeric_limits<int>::max());
    if (code != std::errc() || !fits || (last ? rest != end : rest == end || *rest != ','))
      throw_input_error("--replay",
                        fmt::format("\"{}\" must be X,Y,PASS: column, row and pass, each an integer from 0", text));
    at = rest + 1;
  }
  return {{static_cast<int>(numbers[0]), static_cast<int>(numbers[1])}, numbers[2]};
}

Scene scene_of(const RenderArguments& arguments, Console& console) {
  LoadOptions options;
  options.width = arguments.width;
  options.height = arguments.height;
  options.permissive = arguments.permissive;
  Scene scene(load_scene(arguments.scene, options));
  if (arguments.permissive)
    for (const std::string& note : scene.notes()) console.log(note);
  else if (!scene.notes().empty())
    console.log(fmt::format("{}: {} settings have no effect here; gradslc info lists them", arguments.scene,
                            scene.notes().size()));
  return scene;
}

int replay(const RenderArguments& arguments, const MethodPlan& method, const RenderSettings& settings) {
  const ReplayTarget target = replay_target(*arguments.replay);
  set_thread_count(arguments.threads);
  Console console(arguments.quiet);
  const Scene scene = scene_of(arguments, console);
  fmt::print("{}", to_text(replay_sample(scene, method, settings, target.pixel, target.pass, arguments.parts), scene));
  return k_done;
}

int render(const RenderArguments& arguments) {
  Problems problems;
  const std::optional<MethodPlan> method = method_of(arguments, problems);
  if (!method) return report_problems(problems);
  const RenderSettings settings = settings_of(arguments);
  if (arguments.replay) return replay(arguments, *method, settings);
  const std::filesystem::path output =
      arguments.output.empty() ? std::filesystem::path(arguments.scene).stem().concat(".exr") : arguments.output;
  const bool png = writes_png(output);
  if (png && arguments.debug) throw_input_error(output.string(), "must end in .exr to hold the images of --debug");
  require_writable_file(output);
  set_thread_count(arguments.threads);

  Console console(arguments.quiet);
  const Scene scene = scene_of(arguments, console);
  const Budget budget = arguments.seconds ? Budget{Budget::Kind::seconds, *arguments.seconds}
                                          : Budget{Budget::Kind::spp, static_cast<double>(arguments.spp)};
  const RenderResult result = render_method(
      scene, *method, settings, budget,
      {.parts = arguments.parts, .debug = arguments.debug, .features = arguments.features},
      [&](double fraction, double eta, const std::string& what) { console.progress(fraction, eta, what); });
  if (png)
    write_file_atomically(output, encode_png(result.image, std::exp2(arguments.exposure)));
  else
    write_render(output, result,
                 {{"scene", arguments.scene},
                  {"method", resolved_method(*method, all_registries())},
                  {"settings", to_json(settings)},
                  {"budget", arguments.seconds ? json{{"seconds", *arguments.seconds}} : json{{"spp", arguments.spp}}},
                  {"parts", arguments.parts},
                  {"debug", arguments.debug}});
  const std::optional<Firefly> firefly = largest_contribution(*result.film);
  if (arguments.print_json) {
    json printed = summary(result, *method, output);
    if (firefly) printed["largest_contribution"] = to_json(*firefly);
    fmt::print("{}\n", printed.dump(2));
  } else {
    console.log(summary_line(result, output));
    if (firefly) console.log(firefly_line(*firefly));
  }
  return k_done;
}

}  // namespace

Command render_command(CLI::App& parent) {
  const auto arguments = std::make_shared<RenderArguments>();
  CLI::App& app = *parent.add_subcommand("render", "Renders a scene with one method");
  constexpr int k_largest = std::numeric_limits<int>::max();
  app.add_option("SCENE", arguments->scene, "Mitsuba scene file (.xml)")->required();
  CLI::Option* output = app.add_option(
      "-o,--output", arguments->output,
      "Image: .exr with layers and a .json manifest beside it, or .png to look at (default: SCENE's name.exr)");
  app.add_option("--method", arguments->method, "Integrator's name, or a JSON object as in a config's methods")
      ->capture_default_str();
  app.add_option("--set", arguments->overrides, "Parameter of the method: key=value, vpl.light_paths=1000")
      ->allow_extra_args(false);
  CLI::Option* spp = app.add_option("--spp", arguments->spp, "Samples per pixel")
                         ->check(CLI::Range(1, k_largest))
                         ->capture_default_str();
  CLI::Option* seconds = app.add_option("--seconds", arguments->seconds, "Wall-clock time to spend instead")
                             ->check(CLI::Range(1e-3, 1e9))
                             ->excludes(spp);
  app.add_option("--seed", arguments->seed, "Seed of all random numbers")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()))
      ->capture_default_str();
  app.add_option("--sampler", arguments->sampler, "Where random numbers come from: see list samplers");
  app.add_option("--threads", arguments->threads, "Threads; 0: one per core")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_option("--width", arguments->width, "Image width; alone, it keeps the aspect ratio")
      ->check(CLI::Range(1, 32768));
  app.add_option("--height", arguments->height, "Image height; alone, it keeps the aspect ratio")
      ->check(CLI::Range(1, 32768));
  app.add_option("--max-depth", arguments->max_depth, "Most edges of a path: 1 emission, 2 direct light")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--components", arguments->components, "Light to show: emission,direct,indirect (default: all)");
  app.add_flag("--permissive", arguments->permissive, "Note what the scene file has that is not recognised, and go on");
  app.add_flag("--parts", arguments->parts, "Also write the image split by how the light came");
  app.add_flag("--features", arguments->features,
               "Also write albedo, normal and depth, which some reconstructions need");
  CLI::Option* debug = app.add_flag("--debug", arguments->debug,
                                    "Also write what each pixel's samples cost, and its largest contribution");
  app.add_option("--exposure", arguments->exposure, "Stops added in a .png")
      ->check(CLI::Range(-100.0, 100.0))
      ->capture_default_str();
  CLI::Option* print_json = app.add_flag("--json", arguments->print_json, "Print a summary as JSON to stdout");
  app.add_option(
         "--replay", arguments->replay,
         "X,Y,PASS: print that pixel's sample of that pass, with all paths and connections, instead of an image")
      ->excludes(spp)
      ->excludes(seconds)
      ->excludes(output)
      ->excludes(debug)
      ->excludes(print_json);
  app.add_flag("--quiet", arguments->quiet, "Print errors only");
  app.footer(
      "Examples:\n"
      "  gradslc render scene.xml --method spt --spp 256 -o reference.exr\n"
      "  gradslc render scene.xml --method '{\"integrator\": \"slc\", \"cut_size\": 10}' --seconds 20\n"
      "  gradslc render scene.xml --method slc --set vpl.light_paths=1e5 --components indirect --json\n"
      "  gradslc render scene.xml --width 256 -o preview.png --exposure 1\n"
      "  gradslc render scene.xml --method slc --spp 64 --debug -o fireflies.exr\n"
      "  gradslc render scene.xml --method slc --replay 120,37,5");
  return {&app, [arguments] { return render(*arguments); }};
}

}  // namespace gradslc
