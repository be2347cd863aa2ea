#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "e2e/program.h"

namespace gradslc {
namespace {

using fixtures::Outcome;

/// Bad input of every kind ends with exit code 2, one error line that says what is wrong and where, and no new file.
class BadInput : public fixtures::ProgramTest {
 protected:
  void expect_refusal(const std::vector<std::string>& arguments, const std::vector<std::string>& expected_in_error) {
    const std::vector<std::string> before = files();
    const Outcome outcome = run(arguments);
    std::string command;
    for (const std::string& argument : arguments) command += argument + " ";
    EXPECT_EQ(outcome.exit_code, 2) << command << "\n" << outcome.errors;
    EXPECT_EQ(outcome.output, "") << command;
    EXPECT_EQ(files(), before) << command;
    std::vector<std::string> error_lines;
    std::istringstream stream(outcome.errors);
    for (std::string line; std::getline(stream, line);)
      if (line.find("error: ") != line.npos) error_lines.push_back(line);
    ASSERT_EQ(error_lines.size(), 1u) << command << "\n" << outcome.errors;
    for (const std::string& expected : expected_in_error)
      EXPECT_NE(error_lines[0].find(expected), std::string::npos) << command << "\n" << error_lines[0];
  }

  /// `scene` as bad.xml is refused by render, with all of `expected` in the message.
  void expect_scene_refused(const std::string& scene, const std::vector<std::string>& expected) {
    folder_.write("bad.xml", scene);
    expect_refusal({"render", "bad.xml", "--spp", "1"}, expected);
  }

  /// A config with one member added or replaced is refused by run and by validate alike.
  void expect_config_refused(const std::string& members, const std::vector<std::string>& expected) {
    folder_.write("bad.json", "{" + members + "}");
    expect_refusal({"run", "bad.json"}, expected);
    expect_refusal({"validate", "bad.json"}, expected);
  }
};

/// k_scene with the first `from` replaced.
std::string scene_with(const std::string& from, const std::string& to) {
  std::string scene = fixtures::k_scene;
  const std::size_t at = scene.find(from);
  EXPECT_NE(at, scene.npos) << from;
  return at == scene.npos ? scene : scene.replace(at, from.size(), to);
}

constexpr const char* k_scenes = R"("scenes": [{"file": "scene.xml"}], )";
constexpr const char* k_methods = R"("methods": ["spt"], )";
constexpr const char* k_budget = R"("budget": {"spp": 1})";

TEST_F(BadInput, CommandLine) {
  expect_refusal({}, {"subcommand is required"});
  expect_refusal({"rendr", "scene.xml"}, {"unknown command \"rendr\"", "\"render\""});
  expect_refusal({"render"}, {"SCENE is required"});
  expect_refusal({"render", "scene.xml", "--sp", "4"}, {"--sp"});
  expect_refusal({"render", "scene.xml", "--spp", "-4"}, {"--spp", "-4"});
  expect_refusal({"render", "scene.xml", "--spp", "0"}, {"--spp", "0"});
  expect_refusal({"render", "scene.xml", "--spp", "many"}, {"--spp", "many"});
  expect_refusal({"render", "scene.xml", "--seconds", "-1"}, {"--seconds", "-1"});
  expect_refusal({"render", "scene.xml", "--spp", "4", "--seconds", "1"}, {"--spp", "--seconds"});
  expect_refusal({"render", "scene.xml", "--width", "0"}, {"--width", "0"});
  expect_refusal({"render", "scene.xml", "--max-depth", "0"}, {"--max-depth", "0"});
  expect_refusal({"render", "scene.xml", "--seed", "-1"}, {"--seed", "-1"});
  expect_refusal({"render", "scene.xml", "--threads", "-1"}, {"--threads", "-1"});
  expect_refusal({"render", "scene.xml", "--components", "drect"}, {"--components", "drect", "\"direct\""});
  expect_refusal({"render", "scene.xml", "--sampler", "sobel"}, {"--sampler", "sobel", "\"sobol\""});
  expect_refusal({"render", "scene.xml", "--debug", "-o", "a.png"}, {"a.png", "--debug", ".exr"});
  expect_refusal({"list", "shfts"}, {"shfts", "\"shifts\""});
}

TEST_F(BadInput, Replay) {
  for (const char* text : {"3", "3,4", "3,4,", "3,4,0,0", "3,4,5x", "a,4,0", "-1,4,0", "3,4,-1", "3;4;0", " 3,4,0",
                           "3,4,4294967296", "2147483648,0,0"})
    expect_refusal({"render", "scene.xml", std::string("--replay=") + text},
                   {"--replay", fmt::format("\"{}\"", text), "X,Y,PASS"});
  expect_refusal({"render", "scene.xml", "--replay", "16,0,0"}, {"16,0", "outside", "0 to 15", "0 to 11"});
  expect_refusal({"render", "scene.xml", "--replay", "0,12,0"}, {"0,12", "outside"});
  for (const std::vector<std::string>& other : std::vector<std::vector<std::string>>{
           {"--spp", "4"}, {"--seconds", "1"}, {"-o", "a.exr"}, {"--debug"}, {"--json"}}) {
    std::vector<std::string> arguments{"render", "scene.xml", "--replay", "3,4,0"};
    arguments.insert(arguments.end(), other.begin(), other.end());
    expect_refusal(arguments, {"--replay", other[0]});
  }
}

TEST_F(BadInput, Method) {
  const auto expect_method_refused = [&](const std::string& method, const std::vector<std::string>& expected) {
    expect_refusal({"render", "scene.xml", "--method", method}, expected);
  };
  expect_method_refused("slcc", {"--method", "unknown integrator \"slcc\"", "\"slc\""});
  expect_method_refused("", {"--method"});
  expect_method_refused(R"({"integrator": "slc")", {"--method:1:", "syntax error"});
  expect_method_refused(R"({"cut_size": 10})", {"/integrator", "is missing"});
  expect_method_refused(R"({"integrator": "slc", "cut_sise": 10})", {"--method:1:23", "/cut_sise", "\"cut_size\""});
  expect_method_refused(R"({"integrator": "slc", "cut_size": 0})", {"--method:1:35", "/cut_size", "not 0"});
  expect_method_refused(R"({"integrator": "slc", "cut_size": "10"})", {"/cut_size", "must be an integer"});
  expect_method_refused(R"({"integrator": "slc", "vpl": {"light_paths": -1}})", {"/vpl/light_paths", "not -1"});
  expect_method_refused(R"({"integrator": "gradslc", "shift": "reconection"})", {"/shift", "\"reconnection\""});
  expect_method_refused(R"({"integrator": "gradslc", "reconstruction": "l3"})", {"/reconstruction", "\"l2\""});
  expect_refusal({"render", "scene.xml", "--method", "slc", "--set", "cut_size"}, {"--set cut_size", "key=value"});
  expect_refusal({"render", "scene.xml", "--method", "slc", "--set", "cut_size=0"}, {"--set cut_size=0", "/cut_size"});
}

TEST_F(BadInput, Scene) {
  expect_refusal({"render", "lost.xml"}, {"lost.xml"});
  expect_refusal({"info", "lost.xml"}, {"lost.xml"});
  expect_refusal({"render", "."}, {"."});
  expect_scene_refused("", {"bad.xml"});
  expect_scene_refused("<scene version=\"3.0.0\">\n <shape", {"bad.xml:2"});
  expect_scene_refused(scene_with("type=\"diffuse\"", "type=\"difuse\""), {"bad.xml:7", "difuse", "diffuse"});
  expect_scene_refused(scene_with("\"reflectance\"", "\"reflectanse\""), {"bad.xml:7", "reflectanse"});
  expect_scene_refused(scene_with("<ref id=\"grey\"/>", "<ref id=\"gray\"/>"), {"bad.xml:9", "gray"});
  expect_scene_refused(scene_with("value=\"60\"", "value=\"wide\""), {"bad.xml:3", "wide"});
  expect_scene_refused(scene_with("value=\"16\"", "value=\"-16\""), {"bad.xml:5", "-16"});
}

TEST_F(BadInput, Mesh) {
  folder_.write("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
  const auto with_mesh = [](const std::string& file) {
    return scene_with("</scene>", R"(<shape type="obj"><string name="filename" value=")" + file +
                                      R"("/><ref id="grey"/></shape></scene>)");
  };
  expect_scene_refused(with_mesh("broken.obj"), {"broken.obj:4", "4"});
  expect_scene_refused(with_mesh("lost.obj"), {"lost.obj"});
}

TEST_F(BadInput, Config) {
  const std::string scenes = k_scenes, methods = k_methods, budget = k_budget;
  expect_refusal({"run", "lost.json"}, {"lost.json"});
  expect_refusal({"validate", "lost.json"}, {"lost.json"});
  expect_config_refused(scenes + methods + budget + ",", {"bad.json:1:", "syntax error"});
  expect_config_refused(scenes + methods + budget + ", \"sede\": 1", {"bad.json:1:", "/sede", "\"seed\""});
  expect_config_refused(scenes + methods + budget + ", \"seed\": 1, \"seed\": 2", {"/seed", "given twice"});
  expect_config_refused(scenes + methods + "\n\"budget\": {\"spp\": -4}", {"bad.json:2:19", "/budget/spp", "not -4"});
  expect_config_refused(scenes + methods + R"("budget": {"spp": 1, "seconds": 1})", {"/budget", "one of"});
  expect_config_refused(scenes + methods + R"("budget": {"spp": NaN})", {"bad.json:1:", "NaN"});
  expect_config_refused(scenes + budget, {"/methods", "is missing"});
  expect_config_refused(scenes + R"("methods": ["spd"], )" + budget, {"/methods/0", "\"spt\""});
  expect_config_refused(methods + budget + R"(, "scenes": [{"file": "lost.xml"}])", {"/scenes/0/file", "lost.xml"});
  expect_config_refused(methods + budget + R"(, "scenes": [{"file": "${GRADSLC_LOST}/a.xml"}])",
                        {"/scenes/0/file", "GRADSLC_LOST"});
  expect_config_refused(scenes + methods + budget + R"(, "reference": {"file": "lost.exr"})",
                        {"/reference/file", "lost.exr"});
  folder_.write("broken.xml", "<scene");
  expect_config_refused(methods + budget + R"(, "scenes": [{"file": "broken.xml"}])", {"broken.xml"});
  folder_.write("good.json", "{" + scenes + methods + budget + "}");
  expect_refusal({"run", "good.json", "--set", "budget.spp=-4"}, {"--set budget.spp=-4", "/budget/spp"});
  expect_refusal({"run", "good.json", "--spp", "1", "--seconds", "1"}, {"--spp", "--seconds"});
}

TEST_F(BadInput, Output) {
  folder_.write("file", "");
  folder_.write("good.json", std::string("{") + k_scenes + k_methods + k_budget + "}");
  expect_refusal({"render", "scene.xml", "-o", "file/a.exr"}, {"file", "not a folder"});
  expect_refusal({"render", "scene.xml", "-o", "."}, {"."});
  expect_refusal({"render", "scene.xml", "-o", "a.tif"}, {"a.tif", ".exr"});
  expect_refusal({"run", "good.json", "--out", "file"}, {"file", "not a folder"});
  expect_refusal({"run", "good.json", "--out", "file/out"}, {"file", "not a folder"});
}

TEST_F(BadInput, AFolderThatMayNotBeWrittenIn) {
  // /proc can be written in by nobody, root included.
  folder_.write("good.json", std::string("{") + k_scenes + k_methods + k_budget + "}");
  expect_refusal({"render", "scene.xml", "-o", "/proc/a.exr"}, {"/proc", "cannot be written in"});
  expect_refusal({"run", "good.json", "--out", "/proc/results"}, {"/proc", "cannot be written in"});
}

// A closed box of albedo 0.9 leaves some ten VPLs a light path: a billion paths leave more than can be numbered,
// whatever memory the machine has.
TEST_F(BadInput, MoreLightPathsThanFit) {
  folder_.write("closed.xml", scene_with("</scene>", R"(<shape type="cube"><boolean name="flip_normals" value="true"/>
    <transform name="to_world"><scale value="5"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.9"/></bsdf></shape></scene>)"));
  folder_.write("large.json", R"({ "scenes": [{"file": "closed.xml"}], "max_depth": 100, "budget": {"spp": 1},
    "methods": ["spt", {"name": "Large", "integrator": "gradslc", "vpl": {"light_paths": 1000000000}}] })");
  const std::vector<std::string> expected = {"closed: error: method \"Large\": 1000000000 light paths", " would fit"};
  expect_refusal({"run", "large.json"}, expected);
  expect_refusal({"run", "large.json", "--out", "new/folder"}, expected);
  expect_refusal(
      {"render", "closed.xml", "--method", "slc", "--set", "vpl.light_paths=1000000000", "--max-depth", "100"},
      {"1000000000 light paths", " would fit"});

  const std::string errors = run({"run", "large.json"}).errors;
  std::smatch number;
  ASSERT_TRUE(std::regex_search(errors, number, std::regex("; ([0-9]+) would fit"))) << errors;
  EXPECT_GT(std::stod(number[1]), 1e3);
  EXPECT_LT(std::stod(number[1]), 5e8);
}

TEST_F(BadInput, Images) {
  folder_.write("text.exr", "not an image");
  ASSERT_EQ(run({"render", "scene.xml", "--spp", "1", "-o", "a.exr"}).exit_code, 0);
  ASSERT_EQ(run({"render", "scene.xml", "--spp", "1", "--width", "8", "-o", "b.exr"}).exit_code, 0);
  expect_refusal({"compare", "lost.exr", "a.exr"}, {"lost.exr"});
  expect_refusal({"compare", "a.exr", "lost.exr"}, {"lost.exr"});
  expect_refusal({"compare", "text.exr", "a.exr"}, {"text.exr"});
  expect_refusal({"compare", "a.exr", "b.exr"}, {"16", "8"});
}

TEST_F(BadInput, Reconstruct) {
  folder_.write("text.exr", "not an image");
  ASSERT_EQ(run({"render", "scene.xml", "--spp", "2", "-o", "a.exr"}).exit_code, 0);
  expect_refusal({"reconstruct", "lost.exr", "--type", "none", "-o", "b.exr"}, {"lost.exr"});
  expect_refusal({"reconstruct", "text.exr", "--type", "none", "-o", "b.exr"}, {"text.exr"});
  expect_refusal({"reconstruct", "a.exr", "--type", "l3", "-o", "b.exr"}, {"l3", "l2"});
  expect_refusal({"reconstruct", "a.exr", "--type", "l2", "--set", "alpa=1", "-o", "b.exr"}, {"alpa", "alpha"});
  expect_refusal({"reconstruct", "a.exr", "--type", "l2", "--set", "alpha=-1", "-o", "b.exr"}, {"alpha"});
  expect_refusal({"reconstruct", "a.exr", "--type", "l2", "-o", "b.png"}, {"b.png", ".exr"});
  expect_refusal({"reconstruct", "a.exr", "--type", "l2", "-o", "b.exr"}, {"a.exr", "gradients"});
  expect_refusal({"reconstruct", "a.exr", "--type", "denoise", "-o", "b.exr"}, {"features"});
}

TEST_F(BadInput, Results) {
  std::filesystem::create_directory(folder_.path() / "empty");
  expect_refusal({"report", "lost"}, {"lost"});
  expect_refusal({"report", "scene.xml"}, {"scene.xml"});
  expect_refusal({"report", "empty"}, {"results.csv"});
}

TEST_F(BadInput, ValidateReportsEverythingAtOnce) {
  folder_.write("bad.json", R"({ "scenes": [{"file": "lost.xml"}], "sede": 1,
  "methods": [{"integrator": "slc", "cut_size": 0}, {"integrator": "photons"}],
  "budget": {} })");
  const Outcome outcome = run({"validate", "bad.json"});
  EXPECT_EQ(outcome.exit_code, 2);
  for (const char* expected : {"/sede", "/scenes/0/file", "/methods/0/cut_size", "/methods/1/integrator", "/budget"})
    EXPECT_NE(outcome.errors.find(expected), std::string::npos) << expected << "\n" << outcome.errors;
}

}  // namespace
}  // namespace gradslc
