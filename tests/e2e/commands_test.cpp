#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "core/exr.h"
#include "e2e/program.h"
#include "experiments/results.h"

namespace gradslc {
namespace {

using fixtures::content_of;
using fixtures::Outcome;
using nlohmann::json;

class Commands : public fixtures::ProgramTest {};

TEST_F(Commands, HelpAndVersionSucceed) {
  for (const char* command : {"render", "run", "report", "compare", "reconstruct", "info", "list", "validate"}) {
    const Outcome help = run({command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.output.find(std::string("gradslc ") + command), std::string::npos) << "no example: " << help.output;
  }
  EXPECT_EQ(run({"--help"}).exit_code, 0);
  EXPECT_TRUE(run({"--version"}).output.starts_with("gradslc "));
}

TEST_F(Commands, ListKnowsEveryKind) {
  const json kinds = json::parse(run({"list", "--json"}).output);
  ASSERT_GE(kinds.size(), 6u);
  for (const json& kind : kinds) {
    const std::string name = kind.at("name").get<std::string>();
    const Outcome text = run({"list", name}), data = run({"list", name, "--json"});
    EXPECT_EQ(text.exit_code, 0) << name;
    const json entries = json::parse(data.output);
    EXPECT_FALSE(entries.empty()) << name;
    for (const json& entry : entries) {
      EXPECT_FALSE(entry.at("meaning").get<std::string>().empty()) << entry;
      EXPECT_NE(text.output.find(entry.at("name").get<std::string>()), std::string::npos) << entry;
    }
  }
}

TEST_F(Commands, EveryDefaultParameterIsAValidOne) {
  for (const json& integrator : json::parse(run({"list", "integrators", "--json"}).output)) {
    std::vector<std::string> arguments = {"render", "scene.xml", "--spp", "1", "--method", integrator.at("name")};
    for (const json& parameter : integrator.value("parameters", json::array())) {
      arguments.push_back("--set");
      arguments.push_back(parameter.at("path").get<std::string>() + "=" + parameter.at("default").dump());
    }
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << integrator.at("name") << ": " << outcome.errors;
  }
}

TEST_F(Commands, InfoSaysWhatASceneHolds) {
  const json info = json::parse(run({"info", "scene.xml", "--json"}).output);
  EXPECT_EQ(info.at("width"), 16);
  EXPECT_EQ(info.at("height"), 12);
  EXPECT_EQ(info.at("meshes"), 3);
  EXPECT_EQ(info.at("triangles"), 6);
  EXPECT_EQ(info.at("emissive_triangles"), 2);
  EXPECT_EQ(info.at("lights"), (json{{"area", 1}}));
  EXPECT_EQ(info.at("textures"), 0);
  EXPECT_FALSE(info.at("materials").empty());
  EXPECT_GT(info.at("geometry_bytes"), 0);
  const Outcome text = run({"info", "scene.xml"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.output.find("1 area; 2 emissive triangles"), std::string::npos) << text.output;
}

TEST_F(Commands, RenderWritesTheImageAndSaysWhatItCost) {
  const Outcome outcome = run({"render", "scene.xml", "--spp", "4", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const json summary = json::parse(outcome.output);
  EXPECT_EQ(summary.at("width"), 16);
  EXPECT_EQ(summary.at("height"), 12);
  EXPECT_EQ(summary.at("passes"), 4);
  EXPECT_GT(summary.at("wall_seconds"), 0);
  EXPECT_GT(summary.at("cpu_seconds"), 0);
  EXPECT_GT(summary.at("rays"), 0);
  ASSERT_EQ(summary.at("mean").size(), 3u);
  EXPECT_GT(summary.at("mean").at(0), 0);
  const json manifest = json::parse(content_of(folder_.path() / "scene.json"));
  EXPECT_EQ(manifest.at("method").at("integrator"), "spt");
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.exr", "scene.json", "scene.xml"}));
}

TEST_F(Commands, RenderWritesAPngToLookAt) {
  ASSERT_EQ(run({"render", "scene.xml", "--spp", "1", "-o", "a.png"}).exit_code, 0);
  EXPECT_TRUE(content_of(folder_.path() / "a.png").starts_with("\x89PNG"));
}

TEST_F(Commands, QuietSaysNothing) {
  const Outcome outcome = run({"render", "scene.xml", "--spp", "1", "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output + outcome.errors, "");
}

TEST_F(Commands, OptionsReachTheRenderer) {
  const auto mean = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"render", "scene.xml", "--spp", "2", "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return outcome.exit_code == 0 ? json::parse(outcome.output).at("mean") : json();
  };
  const json all = mean({});
  EXPECT_EQ(mean({}), all) << "the same seed gives the same bits";
  EXPECT_NE(mean({"--seed", "2"}), all);
  EXPECT_NE(mean({"--sampler", "independent"}), all);
  EXPECT_NE(mean({"--max-depth", "2"}), all);
  EXPECT_NE(mean({"--method", R"({"integrator": "slc", "cut_size": 2})"}), all);
  const double direct = mean({"--components", "direct"}).at(0),
               rest = mean({"--components", "emission,indirect"}).at(0);
  EXPECT_NEAR(direct + rest, all.at(0).get<double>(), 1e-5);
  EXPECT_EQ(mean({"--components", "indirect", "--max-depth", "2"}), json({0.0, 0.0, 0.0}));
  const json sized = json::parse(run({"render", "scene.xml", "--spp", "1", "--width", "8", "--json"}).output);
  EXPECT_EQ(sized.at("width"), 8);
  EXPECT_EQ(sized.at("height"), 6);
}

constexpr const char* k_logged_methods[] = {
    "spt",
    R"({"integrator": "vpl", "vpl": {"light_paths": 40}})",
    R"({"integrator": "lightcuts", "vpl": {"light_paths": 400}})",
    R"({"integrator": "slc", "vpl": {"light_paths": 400}})",
    R"({"integrator": "slc", "gather": "tile", "vpl": {"light_paths": 400}})",
    R"({"integrator": "gradslc", "vpl": {"light_paths": 400}})",
    R"({"integrator": "gradslc", "shift": "random_replay", "vpl": {"light_paths": 400}})",
    "gpt",
    R"({"integrator": "gpt", "shift": "random_replay"})"};

/// The line of a replay that begins with `name`, without it.
std::string replayed(const std::string& text, const std::string& name) {
  const std::size_t begin = text.rfind("\n" + name + " ");
  EXPECT_NE(begin, text.npos) << name << ": " << text;
  if (begin == text.npos) return {};
  const std::size_t value = begin + name.size() + 2;
  return text.substr(value, text.find('\n', value) - value);
}

TEST_F(Commands, DebugAddsLayersAndLeavesTheImage) {
  for (const std::string method : k_logged_methods) {
    const auto render = [&](std::vector<std::string> options) {
      options.insert(options.begin(), {"render", "scene.xml", "--spp", "6", "--method", method, "-o", "a.exr"});
      const Outcome outcome = run(options);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
      return std::pair(outcome, read_exr(folder_.path() / "a.exr"));
    };
    const auto [plain_outcome, plain] = render({});
    const auto [outcome, debug] = render({"--debug", "--json"});
    EXPECT_EQ(plain_outcome.errors.find("--replay"), std::string::npos);
    EXPECT_EQ(debug.image, plain.image) << method;
    for (const auto& [name, layer] : plain.layers) {
      ASSERT_TRUE(debug.layers.contains(name)) << name;
      EXPECT_FALSE(name.starts_with("debug_"));
    }
    const std::size_t ratios = plain.layers.contains("dx") ? 2 : 0;
    EXPECT_EQ(debug.layers.size(), plain.layers.size() + 9 + ratios) << method;
    const json largest = json::parse(outcome.output).at("largest_contribution");
    float most = 0;
    for (const float value : std::get<Image<float>>(debug.layers.at("debug_contribution")))
      most = std::max(most, value);
    EXPECT_FLOAT_EQ(largest.at("luminance").get<float>(), most) << method;

    const Outcome replay =
        run({"render", "scene.xml", "--method", method, "--replay", largest.at("replay").get<std::string>()});
    EXPECT_EQ(replay.exit_code, 0) << replay.errors;
    EXPECT_NE(replay.output.find("<- largest"), std::string::npos) << method << "\n" << replay.output;
    EXPECT_TRUE(replayed(replay.output, "sum of the contributions").ends_with(fmt::format("{:.6g}", most)))
        << method << "\n"
        << replay.output;
  }
}

TEST_F(Commands, DebugSaysWhatToReplay) {
  const Outcome outcome = run({"render", "scene.xml", "--spp", "2", "--debug", "--parts"});
  EXPECT_NE(outcome.errors.find("largest contribution: luminance"), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.errors.find("--replay "), std::string::npos) << outcome.errors;
}

TEST_F(Commands, ReplayPrintsThePixelsValueToTheLastBit) {
  for (const std::string method : k_logged_methods)
    for (const bool parts : {false, true}) {
      std::vector<std::string> options{"render", "scene.xml", "--seed", "5", "--method", method};
      if (parts) options.push_back("--parts");
      std::vector<std::string> render = options;
      render.insert(render.end(), {"--spp", "1", "-o", "a.exr"});
      ASSERT_EQ(run(render).exit_code, 0);
      const ExrImage image = read_exr(folder_.path() / "a.exr");
      for (const Pixel pixel : {Pixel{8, 9}, Pixel{15, 11}, Pixel{0, 0}}) {
        std::vector<std::string> replay = options;
        replay.insert(replay.end(), {"--replay", fmt::format("{},{},0", pixel.x, pixel.y)});
        const Outcome outcome = run(replay);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
        const Rgb value = std::get<RgbImage>(image.layers.at("primal"))[pixel];
        EXPECT_EQ(replayed(outcome.output, "value"), fmt::format("({}, {}, {})", value.r, value.g, value.b))
            << method << "\n"
            << outcome.output;
        if (pixel.x == 8) {
          EXPECT_NE(outcome.output.find("\nvertex 1 at"), std::string::npos) << outcome.output;
        }
      }
    }
  EXPECT_EQ(files(), (std::vector<std::string>{"a.exr", "a.json", "scene.xml"}));
}

TEST_F(Commands, CompareOfAnImageWithItselfIsZero) {
  ASSERT_EQ(run({"render", "scene.xml", "--spp", "1", "-o", "a.exr"}).exit_code, 0);
  const json metrics = json::parse(run({"compare", "a.exr", "a.exr", "--json"}).output);
  for (const char* name : {"mse", "relmse", "relmse_trimmed", "mape", "smape", "mean_bias"})
    EXPECT_EQ(metrics.at(name), 0) << name;
  EXPECT_NE(run({"compare", "a.exr", "a.exr"}).output.find("relmse_trimmed"), std::string::npos);
}

/// What a run's file holds gives the same bits as what the run itself had.
TEST_F(Commands, ReconstructRepeatsWhatRenderDid) {
  const char* const method =
      R"({"integrator": "gradslc", "vpl": {"light_paths": 40}, "reconstruction": {"type": "TYPE", "outliers": {"remove": true}}})";
  for (const std::string type : {"none", "l2", "l1", "weighted", "feature", "denoise"}) {
    std::string json_text = method;
    json_text.replace(json_text.find("TYPE"), 4, type);
    ASSERT_EQ(run({"render", "scene.xml", "--spp", "8", "--method", json_text, "-o", "run.exr"}).exit_code, 0);
    const Outcome outcome =
        run({"reconstruct", "run.exr", "--type", type, "--set", "outliers.remove=true", "-o", "again.exr", "--json"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(read_exr(folder_.path() / "again.exr").image, read_exr(folder_.path() / "run.exr").image) << type;
    const json printed = json::parse(outcome.output), manifest = json::parse(content_of(folder_.path() / "again.json"));
    EXPECT_EQ(printed, manifest);
    EXPECT_EQ(manifest.at("reconstruction").at("type"), type);
    EXPECT_EQ(manifest.at("statistics").at("converged"), true);
    const json of_run = json::parse(content_of(folder_.path() / "run.json")).at("reconstruction");
    EXPECT_EQ(manifest.at("statistics"), of_run) << type;
  }
}

TEST_F(Commands, RenderRecordsFeaturesWhereTheyAreAskedFor) {
  ASSERT_EQ(run({"render", "scene.xml", "--spp", "4", "--features", "-o", "run.exr"}).exit_code, 0);
  EXPECT_EQ(run({"reconstruct", "run.exr", "--type", "denoise", "-o", "a.exr"}).exit_code, 0);
}

TEST_F(Commands, RunWritesResultsAndReportRepeatsTheTables) {
  folder_.write("tiny.json", R"({ "scenes": [{"file": "scene.xml"}], "repeats": 2, "components": ["indirect"],
    "methods": ["spt", {"name": "Grad", "integrator": "gradslc", "vpl": {"light_paths": 50}, "reconstruction": "l2"}],
    "budget": {"spp": 4}, "reference": {"spp": 16} })");
  EXPECT_EQ(run({"validate", "tiny.json"}).exit_code, 0);
  const Outcome outcome = run({"run", "tiny.json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const std::filesystem::path results = folder_.path() / "results" / "tiny";
  const std::string csv = content_of(results / "results.csv");
  EXPECT_TRUE(
      csv.starts_with("scene,method,point,repeat,passes,spp,wall_seconds,cpu_seconds,prepare_seconds,render_seconds,"
                      "reconstruct_seconds,rays,mse,relmse,relmse_trimmed,mape,smape,mean_bias"))
      << csv.substr(0, csv.find('\n'));
  EXPECT_NE(csv.find("\nscene,spt,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nscene,Grad,"), std::string::npos) << csv;
  std::filesystem::remove(results / "report.md");
  EXPECT_EQ(run({"report", "results/tiny"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(results / "report.md"));
}

TEST_F(Commands, PartsMeasureTheLightThatVplsCanRepresentAlone) {
  // In a diffuse scene all indirect light is of that kind, so its errors are the image's.
  folder_.write("parts.json", R"({ "scenes": [{"file": "scene.xml"}], "components": ["indirect"], "parts": true,
    "methods": ["spt", {"name": "Tile", "integrator": "slc", "gather": "tile", "vpl": {"light_paths": 50}},
                {"name": "Grad", "integrator": "gradslc", "vpl": {"light_paths": 50}, "reconstruction": "l2"}],
    "budget": {"spp": 4}, "reference": {"spp": 64, "method": {"integrator": "slc", "gather": "tile"}} })");
  const std::filesystem::path results = folder_.path() / "results" / "parts";
  for (const char* reference : {"rendered", "kept"}) {
    const Outcome outcome = run({"run", "parts.json"});
    ASSERT_EQ(outcome.exit_code, 0) << reference << outcome.errors;
    int measured = 0;
    for (const ResultRow& row : read_results(results / "results.csv")) {
      ASSERT_EQ(row.vpl_light_relmse.has_value(), row.method != "Grad") << row.method;
      if (!row.vpl_light_relmse) continue;
      ++measured;
      EXPECT_NEAR(*row.vpl_light_relmse, *row.metric("relmse"), 1e-4 * *row.metric("relmse"));
      EXPECT_NEAR(*row.vpl_light_relmse_trimmed, *row.metric("relmse_trimmed"), 1e-4 * *row.metric("relmse_trimmed"));
    }
    EXPECT_EQ(measured, 2 * 3) << "curve points";
    EXPECT_NE(content_of(results / "report.md").find("VPL light"), std::string::npos);
    std::filesystem::remove(results / "results.csv");
  }
}

TEST_F(Commands, DryRunPrintsThePlanAndRendersNothing) {
  folder_.write("plan.json", R"({ "scenes": [{"file": "scene.xml"}], "budget": {"spp": 1},
    "methods": ["spt", {"name": "Small", "integrator": "slc", "vpl": {"light_paths": 5000}},
                {"name": "Large", "integrator": "gradslc", "vpl": {"light_paths": 1000000000}}] })");
  const std::vector<std::string> before = files();
  const Outcome outcome = run({"run", "plan.json", "--dry-run"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
  EXPECT_EQ(files(), before);
  const std::regex plan(
      "scene: spt: 0 light paths, 0 VPLs, 0 bytes\n"
      "scene: Small: 5000 light paths, [0-9.e+]+ VPLs, [0-9.]+ [KM]iB\n"
      "scene: Large: 1000000000 light paths, [0-9.e+]+ VPLs, [0-9.]+ [GT]iB\n");
  EXPECT_TRUE(std::regex_match(outcome.output, plan)) << outcome.output;
}

TEST_F(Commands, AnyNumberOfThreadsGivesTheSameBits) {
  for (const char* method : {"spt", R"({"integrator": "vpl", "vpl": {"light_paths": 40}})",
                             R"({"integrator": "slc", "vpl": {"light_paths": 400}})",
                             R"({"integrator": "slc", "gather": "tile", "effort": {"pilot_passes": 2}})",
                             R"({"integrator": "gradslc", "shift": "reconnection", "reconstruction": "weighted"})",
                             R"({"integrator": "gradslc", "shift": "random_replay", "reconstruction": "l2"})",
                             R"({"integrator": "gpt", "reconstruction": "weighted"})"}) {
    std::vector<std::string> images;
    for (const char* threads : {"1", "2", "7"}) {
      const Outcome outcome = run({"render", "scene.xml", "--spp", "4", "--seed", "3", "--parts", "--threads", threads,
                                   "--method", method, "-o", "a.exr"});
      ASSERT_EQ(outcome.exit_code, 0) << method << ": " << outcome.errors;
      images.push_back(content_of(folder_.path() / "a.exr"));
    }
    EXPECT_FALSE(images[0].empty());
    EXPECT_TRUE(images[0] == images[1]) << method << ": 1 and 2 threads differ";
    EXPECT_TRUE(images[0] == images[2]) << method << ": 1 and 7 threads differ";
  }
}

}  // namespace
}  // namespace gradslc
