#include "experiments/config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/temporary_folder.h"
#include "unit/experiments/config_fixture.h"

namespace gradslc {
namespace {

using fixtures::fake_registries;
using fixtures::TemporaryFolder;
using nlohmann::json;

/// Loads configs from a folder that has scene files; the environment holds HERE, the folder.
class Config : public ::testing::Test {
 protected:
  Config() {
    folder_.write("scene.xml", "<scene/>");
    folder_.write("other.xml", "<scene/>");
    folder_.write("reference.exr", "");
  }

  std::optional<Experiment> load(const std::string& text, std::vector<std::string> overrides = {}) {
    problems_ = {};
    const ConfigOptions options{std::move(overrides), [this](const std::string& name) -> std::optional<std::string> {
                                  if (name == "HERE") return folder_.path().string();
                                  return std::nullopt;
                                }};
    return load_experiment(folder_.write("test-config.json", text), options, fake_registries(), problems_);
  }

  /// "pointer: message" of every problem.
  std::vector<std::string> problems_of(const std::string& text, std::vector<std::string> overrides = {}) {
    EXPECT_FALSE(load(text, std::move(overrides)).has_value()) << text;
    std::vector<std::string> found;
    for (const Error& error : problems_.all()) found.push_back(error.where().pointer + ": " + error.message());
    return found;
  }

  /// A valid config whose members `changes` replaces (RFC 7396).
  static std::string config_with(const char* changes) {
    json config = json::parse(R"({ "scenes": [{"file": "scene.xml"}], "methods": ["spt"], "budget": {"spp": 4} })");
    config.merge_patch(json::parse(changes));
    return config.dump();
  }

  TemporaryFolder folder_;
  Problems problems_;
};

constexpr const char* k_issue_config = R"({
  "name": "cornell-equal-time", "seed": 3, "repeats": 2, "max_depth": 5, "components": ["indirect"],
  "scenes":  [ { "name": "cornell-box", "file": "${HERE}/scene.xml", "width": 256, "height": 128, "max_depth": 4 },
               { "file": "other.xml" } ],
  "methods": [ { "name": "SPT", "integrator": "spt" },
               { "name": "SLC", "integrator": "slc", "cut_size": 20, "vpl": { "light_paths": 840000 },
                 "reconstruction": { "type": "l2", "alpha": 0.5 } } ],
  "budget": { "seconds": 20 },            // or { "spp": 64 }; comments are allowed
  "reference": { "spp": 4096 } })";

TEST_F(Config, MethodsMayReconstructTheSamplesOfEarlierOnes) {
  const char* methods = R"({ "methods": [ { "name": "a", "integrator": "slc", "cut_size": 7 },
      { "name": "b", "render_of": "a", "reconstruction": { "type": "l2", "alpha": 0.5 } } ] })";
  const std::optional<Experiment> experiment = load(config_with(methods));
  ASSERT_TRUE(experiment) << problems_.all().front().what();
  const MethodPlan &a = experiment->methods[0], &b = experiment->methods[1];
  EXPECT_EQ(a.render_of, "");
  EXPECT_EQ(b.render_of, "a");
  EXPECT_EQ(b.integrator, "slc");
  EXPECT_EQ(b.parameters, a.parameters);
  EXPECT_EQ(b.reconstruction, "l2");
  const std::optional<Experiment> again = load(experiment->resolved.dump());
  ASSERT_TRUE(again) << problems_.all().front().what();
  EXPECT_EQ(again->resolved, experiment->resolved);

  const auto problems = [&](const char* second) {
    json config = json::parse(config_with(methods));
    config["methods"][1] = json::parse(second);
    return problems_of(config.dump());
  };
  using Found = std::vector<std::string>;
  EXPECT_EQ(problems(R"({ "name": "b", "render_of": "A" })"),
            Found{"/methods/1/render_of: no earlier method with samples of its own has the name \"A\"; known: a"});
  EXPECT_EQ(problems(R"({ "render_of": "a" })"),
            Found{"/methods/1/name: is missing: a name that tells it from the method that renders"});
  EXPECT_EQ(problems(R"({ "name": "b", "render_of": "a", "cut_size": 3 })").size(), 1u) << "its samples are those of a";
}

TEST_F(Config, ReadsTheFixedShape) {
  const std::optional<Experiment> experiment = load(k_issue_config);
  ASSERT_TRUE(experiment) << problems_.all().front().what();
  EXPECT_EQ(experiment->name, "cornell-equal-time");
  EXPECT_EQ(experiment->settings.seed, 3u);
  EXPECT_EQ(experiment->settings.max_depth, 5);
  EXPECT_EQ(experiment->settings.components, (Components{false, false, true}));
  EXPECT_EQ(experiment->repeats, 2);
  ASSERT_EQ(experiment->scenes.size(), 2u);
  EXPECT_EQ(experiment->scenes[0].name, "cornell-box");
  EXPECT_EQ(experiment->scenes[0].file, folder_.path() / "scene.xml");
  EXPECT_EQ(experiment->scenes[0].width, 256);
  EXPECT_EQ(experiment->scenes[0].height, 128);
  EXPECT_EQ(experiment->scenes[0].max_depth, 4);
  EXPECT_EQ(experiment->scenes[1].name, "other");
  EXPECT_EQ(experiment->scenes[1].file, folder_.path() / "other.xml");
  EXPECT_FALSE(experiment->scenes[1].width || experiment->scenes[1].height || experiment->scenes[1].max_depth);
  ASSERT_EQ(experiment->methods.size(), 2u);
  EXPECT_EQ(experiment->methods[0].name, "SPT");
  EXPECT_EQ(experiment->methods[0].integrator, "spt");
  EXPECT_EQ(experiment->methods[0].reconstruction, "none");
  EXPECT_EQ(experiment->methods[1].parameters, json::parse(R"({"cut_size": 20, "vpl": {"light_paths": 840000}})"));
  EXPECT_EQ(experiment->methods[1].reconstruction, "l2");
  EXPECT_EQ(experiment->methods[1].reconstruction_parameters, json::parse(R"({"alpha": 0.5})"));
  EXPECT_EQ(experiment->budget.kind, Budget::Kind::seconds);
  EXPECT_EQ(experiment->budget.value, 20);
  EXPECT_EQ(experiment->reference.kind, ReferencePlan::Kind::render);
  EXPECT_EQ(experiment->reference.spp, 4096);
}

TEST_F(Config, HasDefaults) {
  const std::optional<Experiment> experiment = load(config_with("{}"));
  ASSERT_TRUE(experiment) << problems_.all().front().what();
  EXPECT_EQ(experiment->name, "test-config");
  EXPECT_EQ(experiment->repeats, 1);
  EXPECT_FALSE(experiment->parts);
  EXPECT_FALSE(experiment->debug);
  EXPECT_EQ(experiment->settings.components, Components{});
  EXPECT_EQ(experiment->settings.sampler, RenderSettings{}.sampler);
  EXPECT_EQ(experiment->scenes[0].name, "scene");
  EXPECT_EQ(experiment->methods[0].name, "spt");
  EXPECT_EQ(experiment->budget.kind, Budget::Kind::spp);
  EXPECT_EQ(experiment->reference.kind, ReferencePlan::Kind::none);
}

TEST_F(Config, ReadsTheOtherKeys) {
  const std::optional<Experiment> experiment = load(config_with(
      R"({"sampler": "independent", "parts": true, "debug": true, "description": "why", "reference": {"file": "reference.exr"},
          "methods": [{"integrator": "slc", "reconstruction": "l2"}]})"));
  ASSERT_TRUE(experiment) << problems_.all().front().what();
  EXPECT_EQ(experiment->settings.sampler, SamplerKind::independent);
  EXPECT_TRUE(experiment->parts);
  EXPECT_TRUE(experiment->debug);
  EXPECT_EQ(experiment->description, "why");
  EXPECT_EQ(experiment->reference.kind, ReferencePlan::Kind::file);
  EXPECT_EQ(experiment->reference.file, folder_.path() / "reference.exr");
  EXPECT_EQ(experiment->methods[0].name, "slc");
  EXPECT_EQ(experiment->methods[0].reconstruction, "l2");
}

TEST_F(Config, OverridesApplyBeforeTheCheck) {
  const auto experiment = load(k_issue_config, {"budget={\"spp\": 8}", "methods.1.vpl.light_paths=1000", "seed=9"});
  ASSERT_TRUE(experiment) << problems_.all().front().what();
  EXPECT_EQ(experiment->budget.kind, Budget::Kind::spp);
  EXPECT_EQ(experiment->budget.value, 8);
  EXPECT_EQ(experiment->methods[1].parameters.at("vpl").at("light_paths"), 1000);
  EXPECT_EQ(experiment->settings.seed, 9u);
  ASSERT_EQ(problems_of(k_issue_config, {"repeats=-1"}),
            std::vector<std::string>{"/repeats: must be 1 to 1000000, not -1"});
  EXPECT_EQ(problems_.all()[0].where().file, "--set repeats=-1");
}

TEST_F(Config, TheResolvedConfigSaysEverythingAndLoadsAsTheSameExperiment) {
  const std::optional<Experiment> first = load(k_issue_config);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->resolved.at("methods").at(0).at("vpl").at("bounding"), "compensate");
  EXPECT_EQ(first->resolved.at("methods").at(1).at("vpl").at("light_paths"), 840000);
  EXPECT_EQ(first->resolved.at("methods").at(1).at("reconstruction").at("alpha"), 0.5);
  EXPECT_EQ(first->resolved.at("sampler"), "sobol");
  const std::optional<Experiment> second = load(first->resolved.dump());
  ASSERT_TRUE(second) << problems_.all().front().what();
  EXPECT_EQ(second->resolved, first->resolved);
}

TEST_F(Config, EachSlipHasOneMessage) {
  struct Case {
    const char *changes, *problem;
  };
  const Case cases[] = {
      {R"({"sede": 1})", "/sede: unknown key; did you mean \"seed\"?"},
      {R"({"seed": -1})", "/seed: must be at least 0, not -1"},
      {R"({"max_depth": 0})", "/max_depth: must be 1 to 1024 [edges], not 0"},
      {R"({"name": 3})", "/name: must be a string, not 3"},
      {R"({"name": ".a"})",
       "/name: \".a\" is no usable name: 1 to 100 bytes, no control characters, no \".\" or blank first, no blank "
       "last"},
      {R"({"sampler": "halton"})", "/sampler: \"halton\" is unknown; known: independent, sobol"},
      {R"({"components": []})", "/components: is empty; known: emission, direct, indirect"},
      {R"({"components": "direct"})", "/components: must be an array, not a string"},
      {R"({"components": ["indirect", "drect"]})",
       "/components/1: unknown component \"drect\"; did you mean \"direct\"?"},
      {R"({"components": [1]})", "/components/0: must be a string, not 1"},
      {R"({"scenes": null})", "/scenes: is missing: [{\"file\": \"scene.xml\"}, ...]"},
      {R"({"scenes": []})", "/scenes: is empty: at least one scene is needed"},
      {R"({"scenes": {}})", "/scenes: must be an array, not an object"},
      {R"({"scenes": ["scene.xml"]})", "/scenes/0: must be an object, not a string"},
      {R"({"scenes": [{}]})", "/scenes/0/file: is missing: the scene's file"},
      {R"({"scenes": [{"file": "scene.xml", "widht": 4}]})", "/scenes/0/widht: unknown key; did you mean \"width\"?"},
      {R"({"scenes": [{"file": "scene.xml", "width": -4}]})", "/scenes/0/width: must be 1 to 32768 [pixels], not -4"},
      {R"({"scenes": [{"file": "${NOWHERE}/scene.xml"}]})",
       "/scenes/0/file: environment variable \"NOWHERE\" is not set"},
      {R"({"scenes": [{"file": "${HERE/scene.xml"}]})", "/scenes/0/file: \"${\" is not closed by \"}\""},
      {R"({"scenes": [{"file": "scene.xml"}, {"file": "scene.xml"}]})",
       "/scenes/1/name: the name \"scene\" is given twice; add a \"name\" that tells them apart"},
      {R"({"methods": null})", "/methods: is missing: [{\"integrator\": \"spt\"}, ...]"},
      {R"({"methods": []})", "/methods: is empty: at least one method is needed"},
      {R"({"methods": ["spd"]})", "/methods/0: unknown integrator \"spd\"; did you mean \"spt\"?"},
      {R"({"methods": [7]})", "/methods/0: must be an object, not 7"},
      {R"({"methods": [{"name": "a"}]})", "/methods/0/integrator: is missing: the name of the method's integrator"},
      {R"({"methods": [{"integrator": "photons"}]})",
       "/methods/0/integrator: unknown integrator \"photons\"; known: spt, slc"},
      {R"({"methods": ["spt", "spt"]})",
       "/methods/1/name: the name \"spt\" is given twice; add a \"name\" that tells them apart"},
      {R"({"methods": [{"name": "..", "integrator": "spt"}]})",
       "/methods/0/name: \"..\" is no usable name: 1 to 100 bytes, no control characters, no \".\" or blank first, no "
       "blank last"},
      {R"({"methods": [{"integrator": "slc", "cut_sise": 10}]})",
       "/methods/0/cut_sise: unknown key; did you mean \"cut_size\"?"},
      {R"({"methods": [{"integrator": "slc", "vpl": {"light_paths": -840000}}]})",
       "/methods/0/vpl/light_paths: must be at least 1 [paths], not -840000"},
      {R"({"methods": [{"integrator": "slc", "reconstruction": {"type": "l3"}}]})",
       "/methods/0/reconstruction/type: unknown reconstruction \"l3\"; did you mean \"l2\"?"},
      {R"({"methods": [{"integrator": "slc", "reconstruction": "poisson"}]})",
       "/methods/0/reconstruction: unknown reconstruction \"poisson\"; known: none, l2"},
      {R"({"methods": [{"integrator": "slc", "reconstruction": {"type": "l2", "alpha": -1}}]})",
       "/methods/0/reconstruction/alpha: must be 0 to 10, not -1"},
      {R"({"methods": [{"integrator": "slc", "reconstruction": {"type": "none", "alpha": 1}}]})",
       "/methods/0/reconstruction/alpha: unknown key; known: type"},
      {R"({"methods": [{"integrator": "slc", "reconstruction": 2}]})",
       "/methods/0/reconstruction: must be an object, not 2"},
      {R"({"budget": null})", "/budget: is missing: {\"seconds\": 20} or {\"spp\": 64}"},
      {R"({"budget": {"seconds": 3}})", "/budget: must hold one of \"spp\" and \"seconds\""},
      {R"({"budget": {"spp": null}})", "/budget: must hold one of \"spp\" and \"seconds\""},
      {R"({"budget": {"spp": 0}})", "/budget/spp: must be 1 to 1073741824 [samples per pixel], not 0"},
      {R"({"budget": {"spp": -4}})", "/budget/spp: must be 1 to 1073741824 [samples per pixel], not -4"},
      {R"({"budget": {"spp": null, "seconds": 0}})", "/budget/seconds: must be at least 0.001 [s], not 0"},
      {R"({"budget": 20})", "/budget: must be an object, not 20"},
      {R"({"reference": {}})", "/reference: must hold one of \"spp\" and \"file\""},
      {R"({"reference": {"spp": 8, "file": "reference.exr"}})", "/reference: must hold one of \"spp\" and \"file\""},
      {R"({"reference": {"spp": 8, "method": {"integrator": "slc", "cut_sise": 3}}})",
       "/reference/method/cut_sise: unknown key; did you mean \"cut_size\"?"},
      {R"({"reference": {"spp": 8, "method": {"integrator": "slc", "reconstruction": "l2"}}})",
       "/reference/method: must not be reconstructed: a reference is what the method itself converges to"},
      {R"({"reference": {"file": "reference.exr", "method": {"integrator": "slc"}}})",
       "/reference/method: has no effect on an imported reference; remove it"},
      {R"({"reference": {"spp": 1}})", "/reference/spp: must be 2 to 1073741824 [samples per pixel], not 1"},
  };
  for (const Case& bad : cases)
    EXPECT_EQ(problems_of(config_with(bad.changes)), std::vector<std::string>{bad.problem}) << bad.changes;
}

TEST_F(Config, NamesFilesThatAreNotThere) {
  const std::string folder = folder_.path().string();
  EXPECT_EQ(problems_of(config_with(R"({"scenes": [{"file": "lost.xml"}]})")),
            std::vector<std::string>{"/scenes/0/file: file \"" + folder + "/lost.xml\" does not exist"});
  EXPECT_EQ(problems_of(config_with(R"({"reference": {"file": "./"}})")),
            std::vector<std::string>{"/reference/file: \"" + folder + "/\" is a folder, a file is needed"});
  EXPECT_THROW(load_experiment(folder_.path() / "lost.json", {}, fake_registries(), problems_), Error);
}

TEST_F(Config, ReportsEveryProblemWithItsPosition) {
  EXPECT_FALSE(
      load("{ \"repeats\": 0,\n"
           "  \"scenes\": [ { \"file\": \"scene.xml\" } ],\n"
           "  \"methods\": [ { \"integrator\": \"slc\", \"cut_sise\": 10 } ],\n"
           "  \"budget\": { \"spp\": -4 } }"));
  std::vector<std::string> found;
  for (const Error& error : problems_.all())
    found.push_back(std::to_string(error.where().line) + ":" + std::to_string(error.where().column));
  ASSERT_EQ(found, (std::vector<std::string>{"1:14", "3:39", "4:22"}));
  EXPECT_EQ(problems_.all()[1].what(),
            (folder_.path() / "test-config.json").string() +
                ":3:39: error: /methods/0/cut_sise: unknown key; did you mean \"cut_size\"?\n"
                "    3 |   \"methods\": [ { \"integrator\": \"slc\", \"cut_sise\": 10 } ],\n"
                "      |                                       ^~~~~~~~~~");
}

TEST_F(Config, MakesWhatAMethodAsksFor) {
  const std::optional<Experiment> experiment = load(k_issue_config);
  ASSERT_TRUE(experiment);
  const auto integrator = make_integrator(experiment->methods[1], fake_registries());
  const auto& fake = dynamic_cast<const fixtures::FakeIntegrator&>(*integrator);
  EXPECT_EQ(fake.light_paths, 840000);
  EXPECT_EQ(fake.cut_size, 20);
  const auto reconstruction = make_reconstruction(experiment->methods[1], fake_registries());
  ASSERT_TRUE(reconstruction);
  EXPECT_EQ(dynamic_cast<const fixtures::FakeReconstruction&>(*reconstruction).alpha, 0.5f);
  EXPECT_FALSE(make_reconstruction(experiment->methods[0], fake_registries()));
  MethodPlan broken = experiment->methods[1];
  broken.parameters["cut_size"] = 0;
  EXPECT_THROW(make_integrator(broken, fake_registries()), Error);
}

TEST(Label, IsWhatCanNameFilesAndTableRows) {
  for (const char* good : {"SPT", "SLC cut=10", "GradSLC (replay), 84k", "a.b", "a/b", "\xce\xb1 0.2"})
    EXPECT_TRUE(is_label(good)) << good;
  for (const char* bad : {"", ".", "..", ".hidden", "a\nb", "a\x7f", " a", "a "}) EXPECT_FALSE(is_label(bad)) << bad;
  EXPECT_FALSE(is_label(std::string(101, 'a')));
}

}  // namespace
}  // namespace gradslc
