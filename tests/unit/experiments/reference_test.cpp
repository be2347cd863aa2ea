#include "experiments/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/error.h"
#include "core/exr.h"
#include "core/file.h"
#include "experiments/scene_hash.h"
#include "fakes.h"

namespace gradslc {
namespace {

using fakes::World;

struct ReferenceTest : testing::Test {
  World world;
  Scene scene = fakes::fake_scene({20, 10});
  fakes::TemporaryFolder folder{"reference"};
  std::vector<std::string> log_lines;

  Reference obtain(const ReferencePlan& plan, const std::string& hash = "scene", RenderSettings settings = {}) {
    const Makers makers = fakes::makers(world, {{"reference", {.pass_seconds = 1, .noise = 0.5}}});
    return obtain_reference(
        plan, scene, hash, settings, folder.path(), makers, [&](const std::string& line) { log_lines.push_back(line); },
        [](double) {});
  }
  Reference rendered(int spp) { return obtain({ReferencePlan::Kind::render, spp, {}}); }
  std::size_t passes_rendered() const { return world.protocol.size(); }
};

TEST_F(ReferenceTest, HasTwoHalvesThatAreIndependentAndAKnownError) {
  const Reference reference = rendered(64);
  EXPECT_EQ(passes_rendered(), 64u);
  EXPECT_TRUE(reference.images.has_halves());
  EXPECT_NE(reference.images.a, reference.images.b);
  // Per pixel the mean of 64 passes with relative deviation 0.5 has relative variance 0.25 / 64; e2 takes 1 % to 10 %
  // off. 200 pixels with channels alike: the estimate's own deviation is 10 %; five of them: false alarm 6e-7.
  EXPECT_NEAR(*reference.noise, 0.25 / 64, 0.5 * 0.25 / 64);
  // Independent halves: the products of their errors average to 0, with a deviation of v/sqrt(200) (v = 0.25 / 32,
  // relative).
  double product = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    const double truth = fakes::truth({static_cast<int>(i) % 20, static_cast<int>(i) / 20}).r;
    product += (reference.images.a[i].r / truth - 1) * (reference.images.b[i].r / truth - 1) / 200;
  }
  EXPECT_LT(std::abs(product), 5 * 0.25 / 32 / std::sqrt(200));
}

TEST_F(ReferenceTest, IsRenderedByTheMethodThatThePlanNames) {
  const ReferencePlan by_default{.kind = ReferencePlan::Kind::render, .spp = 8};
  ReferencePlan by_lightcuts = by_default;
  by_lightcuts.method = MethodPlan{"any name", "slc", {}, "none", {}};
  by_lightcuts.resolved_method = {{"integrator", "slc"}, {"cut_size", 10}};
  const nlohmann::json key = reference_key(by_default, "scene", {20, 10}, {});
  EXPECT_EQ(key["integrator"], "spt");
  const nlohmann::json other = reference_key(by_lightcuts, "scene", {20, 10}, {});
  EXPECT_EQ(other["integrator"], "slc");
  by_lightcuts.resolved_method["cut_size"] = 20;
  EXPECT_NE(reference_key(by_lightcuts, "scene", {20, 10}, {}), other);
  obtain(by_default);
  obtain(by_lightcuts);
  EXPECT_EQ(passes_rendered(), 16u);  // one does not serve for the other
}

TEST_F(ReferenceTest, IsKeptAndReadAgainToTheBit) {
  const Reference first = rendered(8);
  const Reference second = rendered(8);
  EXPECT_EQ(passes_rendered(), 8u);
  EXPECT_EQ(first.images.a, second.images.a);
  EXPECT_EQ(first.images.b, second.images.b);
  EXPECT_EQ(first.noise, second.noise);
}

TEST_F(ReferenceTest, KeyHoldsAllThatTheImageDependsOnAndNothingElse) {
  const auto obtained = [&](int spp, const std::string& hash, RenderSettings settings) {
    const std::size_t before = passes_rendered();
    obtain({ReferencePlan::Kind::render, spp, {}}, hash, settings);
    return passes_rendered() - before;
  };
  RenderSettings settings;
  EXPECT_EQ(obtained(8, "scene", settings), 8u);
  EXPECT_EQ(obtained(8, "other content", settings), 8u);
  EXPECT_EQ(obtained(7, "scene", settings), 0u) << "rounded up to whole halves: 8";
  EXPECT_EQ(obtained(10, "scene", settings), 10u);
  settings.seed = 99;
  EXPECT_EQ(obtained(8, "scene", settings), 0u) << "has seeds of its own";
  settings.max_depth = 3;
  EXPECT_EQ(obtained(8, "scene", settings), 8u);
  settings.components.direct = false;
  EXPECT_EQ(obtained(8, "scene", settings), 8u);
  settings.sampler = SamplerKind::independent;
  EXPECT_EQ(obtained(8, "scene", settings), 8u);
  scene = fakes::fake_scene({10, 20});
  EXPECT_EQ(obtained(8, "scene", settings), 8u);
}

TEST_F(ReferenceTest, DamagedFileIsNotTrusted) {
  const Reference reference = rendered(8);
  std::ofstream(reference.file, std::ios::app) << "x";
  EXPECT_THROW(rendered(8), Error);
}

TEST_F(ReferenceTest, FileWithoutItsJsonIsRenderedAgain) {
  const Reference reference = rendered(8);
  std::filesystem::remove(std::filesystem::path(reference.file).replace_extension(".json"));
  rendered(8);
  EXPECT_EQ(passes_rendered(), 16u);
}

TEST_F(ReferenceTest, ImportedImageHasNoKnownErrorAndMustFit) {
  const std::filesystem::path file = folder.path() / "given.exr";
  write_exr(file, {RgbImage({20, 10}, Rgb(2)), {}, {}});
  const ReferencePlan plan{ReferencePlan::Kind::file, 0, file};
  const Reference reference = obtain(plan);
  EXPECT_FALSE(reference.images.has_halves());
  EXPECT_FALSE(reference.noise.has_value());
  EXPECT_EQ(reference.images.mean(), RgbImage({20, 10}, Rgb(2)));
  scene = fakes::fake_scene({10, 20});
  EXPECT_THROW(obtain(plan), Error);
  scene = fakes::fake_scene({20, 10});
  write_exr(file, {RgbImage({20, 10}, Rgb(0)), {}, {}});
  EXPECT_THROW(obtain(plan), Error) << "black";
}

TEST(SceneHash, SeesTheFileTheMeshesAndTheCamera) {
  const fakes::TemporaryFolder folder("scene_hash");
  const std::filesystem::path file = folder.path() / "scene.xml";
  write_file_atomically(file, "one");
  const auto hash_of = [&](Resolution resolution, float size) {
    SceneDescription description = fakes::fake_description(resolution, size);
    description.files = {file};
    return scene_hash(Scene(std::move(description)));
  };
  const std::string hash = hash_of({6, 4}, 1);
  EXPECT_EQ(hash_of({6, 4}, 1), hash);
  EXPECT_NE(hash_of({6, 4}, 2), hash) << "mesh";
  EXPECT_NE(hash_of({4, 6}, 1), hash) << "camera";
  write_file_atomically(file, "two");
  EXPECT_NE(hash_of({6, 4}, 1), hash) << "file";
}

TEST(ReferenceFolder, IsSharedWhereTheEnvironmentSaysSo) {
  unsetenv("GRADSLC_REFERENCES");
  EXPECT_EQ(reference_folder("out"), std::filesystem::path("out/references"));
  setenv("GRADSLC_REFERENCES", "/shared/refs", 1);
  EXPECT_EQ(reference_folder("out"), std::filesystem::path("/shared/refs"));
  unsetenv("GRADSLC_REFERENCES");
}

}  // namespace
}  // namespace gradslc
