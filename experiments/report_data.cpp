#include "experiments/report_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/exr.h"
#include "core/file.h"
#include "experiments/number_format.h"
#include "experiments/report_images.h"
#include "experiments/results_folder.h"

namespace gradslc {
namespace {

constexpr double k_busy_load = 0.5;  // of the cores, before a comparison began

/// Value at a JSON pointer, or a null where anything on the way is missing.
nlohmann::json at(const nlohmann::json& document, const char* pointer) {
  const nlohmann::json::json_pointer path(pointer);
  return document.contains(path) ? document.at(path) : nlohmann::json();
}

nlohmann::json read_json(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return nullptr;
  nlohmann::json document = nlohmann::json::parse(read_file(file), nullptr, false);
  return document.is_discarded() ? nlohmann::json() : document;
}

/// The manifests of all runs of the rows, in their order; runs without one are left out.
std::vector<nlohmann::json> read_manifests(const std::filesystem::path& root, const std::vector<ResultRow>& rows) {
  std::vector<nlohmann::json> manifests;
  for (const ResultRow& row : rows) {
    if (!row.final) continue;
    nlohmann::json manifest = read_json(run_path(root, row.scene, row.method, row.repeat) / "image.json");
    if (manifest.is_object()) manifests.push_back(std::move(manifest));
  }
  return manifests;
}

std::string build_sentence(const nlohmann::json& manifest) {
  const nlohmann::json commit = at(manifest, "/build/git_commit");
  return fmt::format("Built from {}{} with {} ({}).",
                     commit.is_string() ? "commit " + commit.get<std::string>() : "sources without a commit",
                     at(manifest, "/build/git_dirty") == true ? " with changes that are not committed" : "",
                     at(manifest, "/build/compiler").get<std::string>(),
                     at(manifest, "/build/flags").get<std::string>());
}

std::string machine_sentence(const nlohmann::json& manifest) {
  return fmt::format("Machine: {}, {} cores, {} threads used, {}.",
                     at(manifest, "/machine/processor").get<std::string>(), at(manifest, "/machine/cores").get<int>(),
                     at(manifest, "/machine/threads").get<int>(), at(manifest, "/machine/system").get<std::string>());
}

std::string load_sentence(const std::vector<nlohmann::json>& manifests) {
  double largest = 0;
  int cores = 1;
  for (const nlohmann::json& manifest : manifests) {
    const nlohmann::json load = at(manifest, "/machine/load_average/0");
    if (load.is_number()) largest = std::max(largest, load.get<double>());
    cores = at(manifest, "/machine/cores").get<int>();
  }
  return fmt::format(
      "Load average (one minute, this program's own earlier work included) before a comparison: at most "
      "{:.2f} on {} cores{}.",
      largest, cores, largest > k_busy_load * cores ? ": wall times may be disturbed, compare CPU seconds" : "");
}

std::vector<std::string> conditions(const std::vector<nlohmann::json>& manifests) {
  if (manifests.empty()) return {"No manifests are left of these runs."};
  std::vector<std::string> sentences;
  const auto add_new = [&](std::string sentence) {
    if (std::find(sentences.begin(), sentences.end(), sentence) == sentences.end())
      sentences.push_back(std::move(sentence));
  };
  for (const nlohmann::json& manifest : manifests) {
    if (at(manifest, "/build/compiler").is_null() || at(manifest, "/machine/processor").is_null()) continue;
    add_new(build_sentence(manifest));
    add_new(machine_sentence(manifest));
  }
  sentences.push_back(load_sentence(manifests));
  return sentences;
}

std::string text_of(const nlohmann::json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

std::string scene_conditions(const nlohmann::json& manifest) {
  if (manifest.is_null()) return "";
  std::vector<std::string> components;
  for (const nlohmann::json& component : at(manifest, "/settings/components")) components.push_back(text_of(component));
  std::string text =
      fmt::format("{} x {} pixels, max_depth {}, components {}, sampler {}.", at(manifest, "/image/width").dump(),
                  at(manifest, "/image/height").dump(), at(manifest, "/settings/max_depth").dump(),
                  fmt::join(components, " + "), text_of(at(manifest, "/settings/sampler")));
  const nlohmann::json spp = at(manifest, "/reference/key/spp"), noise = at(manifest, "/reference/noise_relmse");
  if (spp.is_number() && noise.is_number()) {
    text += fmt::format(" Reference: {} passes of {} in two independent halves, its own relmse {}.", spp.get<int>(),
                        text_of(at(manifest, "/reference/key/integrator")),
                        format_number(noise.get<double>(), Markup::text));
  } else if (at(manifest, "/reference/imported") == true) {
    text += " Reference: an imported image, whose own error is not known.";
  }
  return text;
}

/// The mean of the reference that a manifest names, or an empty image where it is gone.
RgbImage read_reference_image(const std::filesystem::path& root, const nlohmann::json& manifest) {
  const nlohmann::json named = at(manifest, "/reference/file");
  if (!named.is_string()) return {};
  const std::filesystem::path file = named.get<std::string>();
  for (const std::filesystem::path& candidate : {file, root / "references" / file.filename()}) {
    if (std::filesystem::exists(candidate)) return read_exr(candidate).image;
  }
  return {};
}

ReportImage make_image(const std::string& scene, const std::string& name, const std::string& caption, std::string png) {
  return {caption, std::filesystem::path("images") / file_name_for(scene) / (file_name_for(name) + ".png"),
          std::move(png)};
}

void add_images(SceneReport& report, const std::filesystem::path& root, const nlohmann::json& manifest) {
  const std::string& scene = report.summary.scene;
  const RgbImage reference = read_reference_image(root, manifest);
  std::optional<float> exposure;
  if (!reference.empty()) {
    exposure = display_exposure(reference);
    report.images.push_back(make_image(scene, "reference", "reference", encode_png(reference, *exposure)));
  }
  for (const MethodSummary& method : report.summary.methods) {
    const std::filesystem::path file = run_path(root, scene, method.method, 0) / "image.exr";
    if (!std::filesystem::exists(file)) continue;
    const RgbImage image = read_exr(file).image;
    if (!exposure) exposure = display_exposure(image);
    report.images.push_back(make_image(scene, "method-" + method.method, method.method, encode_png(image, *exposure)));
    if (reference.resolution() != image.resolution()) continue;
    report.error_images.push_back(make_image(scene, "error-" + method.method, method.method + ", error",
                                             encode_png(error_image(image, reference), 1)));
  }
}

/// Rows of one curve point over the repeats.
PlotPoint plot_point(const std::vector<const ResultRow*>& rows) {
  PlotPoint point;
  const auto relmse = [](const ResultRow* row) { return *row->metric("relmse"); };
  const auto smaller = [&](const ResultRow* a, const ResultRow* b) { return relmse(a) < relmse(b); };
  const auto [smallest, largest] = std::minmax_element(rows.begin(), rows.end(), smaller);
  point.y_lower = relmse(*smallest);
  point.y_upper = relmse(*largest);
  for (const ResultRow* row : rows) point.x += row->wall_seconds, point.y += relmse(row);
  point.x /= static_cast<double>(rows.size());
  point.y /= static_cast<double>(rows.size());
  return point;
}

}  // namespace

std::optional<LogPlot> convergence_plot(std::span<const ResultRow> rows, const std::string& scene) {
  std::vector<std::string> methods;
  std::map<std::pair<std::string, double>, std::vector<const ResultRow*>> points;  // by method and target
  std::optional<double> noise;
  for (const ResultRow& row : rows) {
    if (row.scene != scene || !row.metric("relmse")) continue;
    if (std::find(methods.begin(), methods.end(), row.method) == methods.end()) methods.push_back(row.method);
    points[{row.method, row.target}].push_back(&row);
    if (row.reference_noise) noise = row.reference_noise;
  }
  if (methods.empty()) return std::nullopt;
  LogPlot plot{scene, "seconds (prepare + render + this point's reconstruction)", "relmse", {}, std::nullopt};
  for (const std::string& method : methods) {
    PlotCurve& curve = plot.curves.emplace_back();
    curve.name = method;
    std::size_t repeats = 0;
    for (const auto& [key, same] : points) {
      if (key.first == method) repeats = std::max(repeats, same.size());
    }
    for (const auto& [key, same] : points) {
      if (key.first == method && same.size() == repeats) curve.points.push_back(plot_point(same));
    }
  }
  if (noise) plot.level = LogPlot::Level{*noise, "the reference's own relmse"};
  return plot;
}

ReportData read_report_data(const std::filesystem::path& root) {
  const std::vector<ResultRow> rows = read_results(root / "results.csv");
  const std::vector<nlohmann::json> manifests = read_manifests(root, rows);
  ReportData data;
  const nlohmann::json name = at(read_json(root / "experiment.json"), "/name");
  data.name = name.is_string() ? name.get<std::string>() : root.filename().string();
  data.conditions = conditions(manifests);
  for (SceneSummary& summary : summarise(rows)) {
    SceneReport& report = data.scenes.emplace_back();
    const auto of_scene = [&](const nlohmann::json& m) { return at(m, "/scene/name") == summary.scene; };
    const auto manifest = std::find_if(manifests.begin(), manifests.end(), of_scene);
    report.verdict = verdict(summary);
    report.conditions = manifest != manifests.end() ? scene_conditions(*manifest) : "";
    report.plot = convergence_plot(rows, summary.scene);
    report.plot_file = std::filesystem::path("plots") / (file_name_for(summary.scene) + ".svg");
    report.plot_id = fmt::format("plot{}", data.scenes.size());
    report.summary = std::move(summary);
    add_images(report, root, manifest != manifests.end() ? *manifest : nlohmann::json());
  }
  return data;
}

}  // namespace gradslc
