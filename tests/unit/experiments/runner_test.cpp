#include "experiments/runner.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include <fstream>

#include "core/error.h"
#include "core/exr.h"
#include "core/file.h"
#include "experiments/render.h"
#include "experiments/results_folder.h"
#include "experiments/sha256.h"
#include "fakes.h"

namespace gradslc {
namespace {

using fakes::Speed;
using fakes::World;

struct RunnerTest : testing::Test {
  World world;
  fakes::TemporaryFolder folder{"runner"};
  std::map<std::string, Speed> speeds = {
      {"reference", {.pass_seconds = 0.1, .noise = 0.5}},
      {"A", {.prepare_seconds = 0.5, .pass_seconds = 0.2, .noise = 1}},
      {"B", {.prepare_seconds = 1, .pass_seconds = 0.1, .reconstruct_seconds = 0.3, .noise = 0.5}},
  };
  float scene_size = 1;
  std::vector<std::string> log_lines;

  RunnerTest() { write_file_atomically(scene_file(), "<scene/>"); }
  std::filesystem::path scene_file() const { return folder.path() / "scene.xml"; }
  std::filesystem::path out() const { return folder.path() / "results"; }

  Experiment experiment(Budget budget, int repeats = 2) const {
    Experiment e;
    e.name = "test";
    e.repeats = repeats;
    e.budget = budget;
    e.scenes = {{"one", scene_file(), 12, 8, {}}};
    e.methods = {fakes::method("A"), fakes::method("B", "fake")};
    e.reference = {ReferencePlan::Kind::render, 256, {}};
    e.resolved = {{"name", "test"}, {"repeats", repeats}, {"budget", budget.value}};
    return e;
  }
  void run(const Experiment& e) {
    RunOptions options;
    options.out = out();
    options.log = [&](const std::string& line) { log_lines.push_back(line); };
    run_experiment(e, options, fakes::makers(world, speeds, scene_size));
  }
  std::vector<ResultRow> rows() const { return read_results(out() / "results.csv"); }
  std::size_t passes_of(const std::string& name) const {
    return static_cast<std::size_t>(std::count(world.protocol.begin(), world.protocol.end(), name));
  }
};

constexpr Budget k_spp{Budget::Kind::spp, 8};
constexpr Budget k_seconds{Budget::Kind::seconds, 10};

TEST_F(RunnerTest, WritesARowPerMethodRepeatAndCurvePoint) {
  run(experiment(k_spp));
  const std::vector<ResultRow> all = rows();
  ASSERT_EQ(all.size(), 2u * 2 * 4);
  int finals = 0;
  for (const ResultRow& row : all) {
    EXPECT_EQ(row.scene, "one");
    EXPECT_EQ(row.metrics.size(), metric_registry().size());
    EXPECT_NEAR(row.wall_seconds, row.prepare_seconds + row.render_seconds + row.reconstruct_seconds, 1e-12);
    EXPECT_NEAR(row.cpu_seconds, 2 * row.wall_seconds, 1e-9);
    EXPECT_EQ(row.primal_relmse.has_value(), row.method == "B");
    if (!row.final) continue;
    ++finals;
    EXPECT_EQ(row.passes, 8);
    // Noise s per pass: relmse about s^2 / 8 (a little less: e2). 96 pixels: deviation about 15 %; bounds at more
    // than 3.
    const double expected = (row.method == "A" ? 1.0 : 0.25) / 8;
    EXPECT_GT(*row.metric("relmse"), 0.4 * expected);
    EXPECT_LT(*row.metric("relmse"), 1.6 * expected);
  }
  EXPECT_EQ(finals, 4);
}

TEST_F(RunnerTest, ReconstructsTheSameSamplesInSeveralWays) {
  Experiment e = experiment(k_spp);
  speeds["B too"] = {};
  MethodPlan other = fakes::method("B too");
  other.render_of = "B";
  e.methods.push_back(other);
  run(e);
  EXPECT_EQ(passes_of("B"), 2u * 8) << "rendered once";
  EXPECT_EQ(passes_of("B too"), 0u);
  std::map<std::pair<int, int>, ResultRow> of_b;
  int found = 0;
  for (const ResultRow& row : rows())
    if (row.method == "B") of_b[{row.repeat, row.passes}] = row;
  for (const ResultRow& row : rows()) {
    if (row.method != "B too") continue;
    ++found;
    const ResultRow& b = of_b.at({row.repeat, row.passes});
    EXPECT_EQ(row.metric("relmse"), b.metric("relmse")) << "fake reconstructions leave the primal as it is";
    EXPECT_NEAR(row.wall_seconds, b.wall_seconds - 0.3, 1e-9);
    EXPECT_EQ(row.rays, b.rays);
  }
  EXPECT_EQ(found, 2 * 4);
}

TEST_F(RunnerTest, EqualTimeIsEqualAndSaysByHowMuchItMissed) {
  run(experiment(k_seconds));
  for (const ResultRow& row : rows()) {
    if (!row.final) continue;
    EXPECT_LE(row.wall_seconds, 10 + 1e-9);
    EXPECT_GT(row.wall_seconds, 10 - 0.2 - 1e-9);
    EXPECT_NEAR(*row.budget_miss, row.wall_seconds / 10 - 1, 1e-12);
    EXPECT_FALSE(row.has_flag("budget_missed"));
  }
}

TEST_F(RunnerTest, RepeatsDifferAndTheSameSeedGivesTheSameBits) {
  run(experiment(k_spp));
  const std::vector<ResultRow> first = rows();
  EXPECT_NE(*first.front().metric("mse"), *first.back().metric("mse"));
  const auto image = [&](const char* method, int repeat) {
    return read_exr(run_path(out(), "one", method, repeat) / "image.exr").image;
  };
  const RgbImage a0 = image("A", 0);
  EXPECT_NE(a0, image("A", 1));
  std::filesystem::remove_all(out());
  world = World();
  run(experiment(k_spp));
  EXPECT_EQ(to_csv(rows()), to_csv(first)) << "times are the fake clock's";
  EXPECT_EQ(image("A", 0), a0);
  EXPECT_NE(repeat_seed(1, 1), repeat_seed(2, 0)) << "seeds are hashed, not added";
}

TEST_F(RunnerTest, CompleteFolderIsKept) {
  run(experiment(k_spp));
  const std::string before = read_file(out() / "results.csv");
  const std::size_t passes = world.protocol.size();
  run(experiment(k_spp));
  EXPECT_EQ(world.protocol.size(), passes) << "neither methods nor reference";
  EXPECT_EQ(read_file(out() / "results.csv"), before);
}

TEST_F(RunnerTest, IncompleteComparisonIsRepeatedAsAWhole) {
  run(experiment(k_spp));
  const std::string before = read_file(out() / "results.csv");
  std::filesystem::remove(run_path(out(), "one", "B", 1) / "image.json");
  std::filesystem::remove(out() / "results.csv");
  world.protocol.clear();
  run(experiment(k_spp));
  EXPECT_EQ(passes_of("A"), 8u) << "methods take turns, so A runs again with B";
  EXPECT_EQ(passes_of("B"), 8u);
  EXPECT_EQ(passes_of("reference"), 0u);
  EXPECT_EQ(read_file(out() / "results.csv"), before);
}

TEST_F(RunnerTest, OtherConfigInTheSameFolderIsRefusedAndSaysWhere) {
  run(experiment(k_spp));
  Experiment other = experiment(k_spp);
  other.resolved["budget"] = 16;
  const std::string before = read_file(out() / "results.csv");
  try {
    run(other);
    FAIL() << "must be refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_NE(error.message().find("/budget is 8.0 there and 16 now"), std::string::npos) << error.message();
  }
  EXPECT_EQ(read_file(out() / "results.csv"), before);
}

TEST_F(RunnerTest, ChangedSceneIsRefused) {
  run(experiment(k_spp));
  scene_size = 2;
  EXPECT_THROW(run(experiment(k_spp)), Error);
}

TEST_F(RunnerTest, FolderThatAnotherProcessHoldsIsRefused) {
  std::filesystem::create_directories(out());
  const int lock = open((out() / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  ASSERT_EQ(flock(lock, LOCK_EX), 0);
  try {
    run(experiment(k_spp));
    ADD_FAILURE() << "must be refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::failure);
  }
  EXPECT_TRUE(world.protocol.empty());
  close(lock);
  EXPECT_NO_THROW(run(experiment(k_spp)));
}

TEST_F(RunnerTest, BadInputIsFoundBeforeAnythingIsWritten) {
  Experiment e = experiment(k_spp);
  e.scenes.push_back({"two", folder.path() / "missing.xml", {}, {}, {}});
  Makers makers = fakes::makers(world, speeds);
  makers.scene = [](const ScenePlan& plan) {
    read_file(plan.file);
    return fakes::fake_scene();
  };
  RunOptions options;
  options.out = out();
  EXPECT_THROW(run_experiment(e, options, makers), Error);
  EXPECT_FALSE(std::filesystem::exists(out()));
  EXPECT_TRUE(world.protocol.empty()) << "nor rendered";
}

TEST_F(RunnerTest, FolderThatCannotBeMadeIsBadInput) {
  write_file_atomically(out(), "a file");
  try {
    run(experiment(k_spp));
    FAIL() << "must be refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
  }
}

TEST_F(RunnerTest, ManifestSaysWhatIsNeededToRenderAgain) {
  run(experiment(k_seconds, 1));
  const std::filesystem::path image = run_path(out(), "one", "B", 0) / "image.exr";
  const nlohmann::json manifest =
      nlohmann::json::parse(read_file(std::filesystem::path(image).replace_extension(".json")));
  EXPECT_EQ(manifest.at("settings").at("seed"), repeat_seed(1, 0));
  EXPECT_EQ(manifest.at("method").at("name"), "B");
  EXPECT_EQ(manifest.at("config").at("name"), "test");
  EXPECT_EQ(manifest.at("passes"), rows().back().passes);
  EXPECT_EQ(manifest.at("image").at("sha256"), sha256_of_file(image));
  EXPECT_EQ(manifest.at("scene").at("file_sha256"), sha256("<scene/>"));
  EXPECT_EQ(manifest.at("counters").at("fake_counter"), 7);
  EXPECT_EQ(manifest.at("seconds").at("wall"), rows().back().wall_seconds);
  EXPECT_GT(manifest.at("peak_memory_bytes"), 0);
  for (const char* key : {"compiler", "flags", "libraries", "git_commit"})
    EXPECT_TRUE(manifest.at("build").contains(key));
  for (const char* key : {"processor", "threads", "load_average"}) EXPECT_TRUE(manifest.at("machine").contains(key));
  const ExrImage content = read_exr(image);
  EXPECT_TRUE(content.layers.contains("primal_variance_a"));
}

TEST_F(RunnerTest, WithoutAReferenceTimesAreStillMeasured) {
  Experiment e = experiment(k_spp, 1);
  e.reference.kind = ReferencePlan::Kind::none;
  run(e);
  EXPECT_EQ(passes_of("reference"), 0u);
  EXPECT_FALSE(rows().front().metric("mse").has_value());
  EXPECT_NE(read_file(out() / "report.md").find("No reference"), std::string::npos);
}

TEST_F(RunnerTest, RowsNearTheReferencesNoiseAreFlagged) {
  Experiment e = experiment(k_spp, 1);
  e.reference.spp = 2;
  run(e);
  EXPECT_TRUE(rows().back().has_flag("near_reference_noise"));
  EXPECT_FALSE(rows().front().has_flag("near_reference_noise")) << "A's first pass is far above it";
}

TEST_F(RunnerTest, TraitsOfAMethodAreFlagged) {
  speeds.at("A").traits = {.gradients = false, .biased = true, .truncated = true, .one_set = true};
  run(experiment(k_spp, 1));
  EXPECT_EQ(rows().front().flags, (std::vector<std::string>{"biased", "truncated", "one_set"}));
}

TEST_F(RunnerTest, ProgressRisesToOne) {
  std::vector<double> fractions;
  RunOptions options;
  options.out = out();
  options.progress = [&](double fraction, double eta, const std::string& what) {
    fractions.push_back(fraction);
    EXPECT_GE(eta, 0);
    EXPECT_FALSE(what.empty());
  };
  run_experiment(experiment(k_spp), options, fakes::makers(world, speeds));
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_NEAR(fractions.back(), 1, 1e-12);
}

TEST_F(RunnerTest, RenderOneMethod) {
  const Scene scene = fakes::fake_scene();
  const Makers makers = fakes::makers(world, speeds);
  const RenderResult result = render_method(scene, fakes::method("B", "fake"), {}, k_seconds, {}, makers, {});
  EXPECT_LE(result.wall_seconds, 10 + 1e-9) << "the last reconstruction was predicted";
  EXPECT_GT(result.wall_seconds, 10 - 0.1 - 1e-9);
  EXPECT_NEAR(result.wall_seconds, result.prepare_seconds + result.render_seconds + result.reconstruct_seconds, 1e-12);
  EXPECT_EQ(result.reconstruction->iterations, 3);
  write_render(folder.path() / "b.exr", result, {{"mine", 1}});
  const nlohmann::json manifest = nlohmann::json::parse(read_file(folder.path() / "b.json"));
  EXPECT_EQ(manifest.at("mine"), 1);
  EXPECT_EQ(manifest.at("passes"), result.passes);
  EXPECT_EQ(read_exr(folder.path() / "b.exr").image, result.image);
}

TEST(FileNames, StayDistinctAndSafe) {
  EXPECT_EQ(file_name_for("cornell-box_2.0"), "cornell-box_2.0");
  for (const char* name : {"", "..", ".hidden", "a/b", "a b", "ä"}) {
    const std::string file = file_name_for(name);
    EXPECT_EQ(file.find_first_of("/ "), std::string::npos);
    EXPECT_NE(file[0], '.') << name;
    EXPECT_NE(file, name);
  }
  EXPECT_NE(file_name_for("a/b"), file_name_for("a b"));
}

}  // namespace
}  // namespace gradslc
