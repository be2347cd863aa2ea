#include "experiments/turns.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/comparison.h"
#include "fakes.h"

namespace gradslc {
namespace {

using fakes::Speed;
using fakes::World;

constexpr double k_rounding = 1e-9;

MethodRun make_run(World& world, const Scene& scene, const std::string& name, const Speed& speed, Budget budget,
                   bool reconstructs = false) {
  const Makers makers = fakes::makers(world, {{name, speed}});
  const MethodPlan method = fakes::method(name, reconstructs ? "fake" : "none");
  MethodRun::Reconstructions reconstructions;
  reconstructions.push_back(makers.reconstruction(method));
  return MethodRun({name, {}, budget, {}, curve_targets(budget)}, makers.integrator(method), std::move(reconstructions),
                   scene, makers.clock);
}

std::vector<CurvePoint> run_alone(World& world, const Speed& speed, Budget budget, bool reconstructs = false) {
  const Scene scene = fakes::fake_scene();
  MethodRun run = make_run(world, scene, "a", speed, budget, reconstructs);
  std::vector<CurvePoint> points;
  take_turns(
      std::span(&run, 1), 0, [&](std::size_t, const PointImage& p) { points.push_back(p.point); }, [](double) {});
  return points;
}

constexpr Budget spp(double value) { return {Budget::Kind::spp, value}; }
constexpr Budget seconds(double value) { return {Budget::Kind::seconds, value}; }

TEST(CurveTargets, DoubleUpToTheBudget) {
  EXPECT_EQ(curve_targets(spp(1)), (std::vector<double>{1}));
  EXPECT_EQ(curve_targets(spp(6)), (std::vector<double>{1, 2, 4, 6}));
  EXPECT_EQ(curve_targets(spp(8)), (std::vector<double>{1, 2, 4, 8}));
  EXPECT_EQ(curve_targets(seconds(128)), (std::vector<double>{1, 2, 4, 8, 16, 32, 64, 128}));
}

TEST(MethodRun, PassesOfAnSppBudgetAreExact) {
  World world;
  const std::vector<CurvePoint> points = run_alone(world, {.prepare_seconds = 3, .pass_seconds = 0.5}, spp(6));
  ASSERT_EQ(points.size(), 4u);
  const int passes[] = {1, 2, 4, 6};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(points[i].passes, passes[i]);
    EXPECT_NEAR(points[i].total().wall, 3 + 0.5 * passes[i], k_rounding);
    EXPECT_NEAR(points[i].total().cpu, 2 * (3 + 0.5 * passes[i]), k_rounding) << "two threads";
    EXPECT_EQ(points[i].rays, 24u * static_cast<unsigned>(passes[i]));
    EXPECT_EQ(points[i].final, i == 3);
  }
}

TEST(MethodRun, BudgetInSecondsIsNotOverrun) {
  World world;
  // 10 s: prepare 1, passes of 0.3: 30 passes make exactly 10.
  for (const double pass : {0.3, 0.7, 1.1}) {
    const CurvePoint last = run_alone(world, {.prepare_seconds = 1, .pass_seconds = pass}, seconds(10)).back();
    EXPECT_TRUE(last.final);
    EXPECT_LE(last.total().wall, 10 + k_rounding);
    EXPECT_GT(last.total().wall, 10 - pass - k_rounding) << "one more pass would have fitted";
  }
}

TEST(MethodRun, LastReconstructionIsPredictedAndEarlierOnesAreNotCharged) {
  World world;
  const Speed speed{.prepare_seconds = 1, .pass_seconds = 0.25, .reconstruct_seconds = 2};
  const std::vector<CurvePoint> points = run_alone(world, speed, seconds(32), true);
  const CurvePoint& last = points.back();
  EXPECT_LE(last.total().wall, 32 + k_rounding);
  EXPECT_GT(last.total().wall, 32 - 0.25 - k_rounding);
  ASSERT_GT(points.size(), 2u);
  for (const CurvePoint& point : points) {
    EXPECT_NEAR(point.reconstruct.wall, 2, k_rounding);
    EXPECT_NEAR(point.total().wall, 1 + 0.25 * point.passes + 2, k_rounding) << "its own reconstruction only";
  }
  EXPECT_NEAR(world.now.wall - 100, 1 + 0.25 * last.passes + 2 * static_cast<double>(points.size()), k_rounding);
}

TEST(MethodRun, ReconstructionsOfTheSameSamplesAreChargedWithTheirOwnTime) {
  World world;
  const Scene scene = fakes::fake_scene();
  const Makers makers = fakes::makers(world, {{"a", {.prepare_seconds = 1, .pass_seconds = 0.25}}});
  MethodRun::Reconstructions reconstructions(3);
  reconstructions[0] = std::make_unique<fakes::FakeReconstruction>(world, 0.5);
  reconstructions[2] = std::make_unique<fakes::FakeReconstruction>(world, 2);
  MethodRun run({"a", {}, seconds(32), {}, curve_targets(seconds(32))}, makers.integrator(fakes::method("a")),
                std::move(reconstructions), scene, makers.clock);
  std::vector<PointImage> images;
  take_turns(
      std::span(&run, 1), 0, [&](std::size_t, PointImage p) { images.push_back(std::move(p)); }, [](double) {});
  const double times[] = {0.5, 0, 2};
  ASSERT_EQ(images.size() % 3, 0u);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const CurvePoint& point = images[i].point;
    EXPECT_EQ(images[i].reconstruction, i % 3);
    EXPECT_NEAR(point.reconstruct.wall, times[i % 3], k_rounding);
    EXPECT_NEAR(point.total().wall + point.waited_seconds, 1 + 0.25 * point.passes + 2, k_rounding);
    EXPECT_EQ(point.passes, images[i / 3 * 3].point.passes) << "the same samples";
    EXPECT_EQ(images[i].image, images[i / 3 * 3].image) << "which fakes leave as they are";
  }
  for (std::size_t i = images.size() - 3; i < images.size(); ++i) {
    EXPECT_TRUE(images[i].point.final);
    EXPECT_TRUE(make_row(images[i].point, seconds(32)).flags.empty());
  }
  EXPECT_GT(images.back().point.total().wall, 32 - 0.25 - k_rounding) << "the longest fills the budget";
}

TEST(MethodRun, CurvePointsLieWithinTheirSeconds) {
  World world;
  const std::vector<CurvePoint> points =
      run_alone(world, {.pass_seconds = 0.1, .reconstruct_seconds = 0.05}, seconds(64), true);
  ASSERT_EQ(points.size(), 8u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].target, 64 / std::exp2(7 - static_cast<double>(i)), k_rounding);
    const double unpredicted = i == 0 ? 0.05 : 0;  // the first point's reconstruction
    EXPECT_LE(points[i].total().wall, points[i].target + unpredicted + k_rounding);
    EXPECT_GT(points[i].total().wall, points[i].target - 0.1 - k_rounding);
  }
}

TEST(MethodRun, SlowMethodGetsOnePassAndLeavesOutEarlyPoints) {
  World world;
  const std::vector<CurvePoint> points = run_alone(world, {.prepare_seconds = 2, .pass_seconds = 50}, seconds(10));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].passes, 1);
  EXPECT_TRUE(points[0].final);
  EXPECT_EQ(make_row(points[0], seconds(10)).flags.size(), 0u) << "within one pass";
  EXPECT_NEAR(*make_row(points[0], seconds(10)).budget_miss, 4.2, k_rounding) << "but shown";
}

TEST(MethodRun, NoTwoPointsHaveTheSamePasses) {
  World world;
  std::vector<CurvePoint> points = run_alone(world, {.pass_seconds = 3}, seconds(64));
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_GT(points[i].passes, points[i - 1].passes);
  EXPECT_EQ(points.back().passes, 21);
}

TEST(MethodRun, PassThatTookUnusuallyLongShowsAsAMiss) {
  World world;
  const Speed speed{.pass_seconds = 1, .slow_pass_seconds = 30, .slow_pass = 90};
  const CurvePoint last = run_alone(world, speed, seconds(100)).back();
  const ResultRow row = make_row(last, seconds(100));
  EXPECT_NEAR(*row.budget_miss, 0.2, k_rounding);
  EXPECT_TRUE(row.has_flag("budget_missed"));
}

TEST(Turns, MethodsAdvanceTogetherWhateverTheirSpeed) {
  World world;
  const Scene scene = fakes::fake_scene();
  std::vector<MethodRun> runs;
  const Budget budget = seconds(100);
  runs.push_back(make_run(world, scene, "fast", {.pass_seconds = 0.01}, budget));
  runs.push_back(make_run(world, scene, "slow", {.prepare_seconds = 5, .pass_seconds = 1}, budget));
  double largest_gap = 0;
  take_turns(
      runs, 0, [](std::size_t, const PointImage&) {},
      [&](double) { largest_gap = std::max(largest_gap, std::abs(runs[0].progress() - runs[1].progress())); });
  // A slice is 2 % of the budget; the slow one's preparation (5 %) is the longest that it is ahead.
  EXPECT_LE(largest_gap, 0.05 + 0.02 + k_rounding);
  EXPECT_NEAR(runs[0].render_time().wall, 100, 0.011);
  EXPECT_NEAR(runs[1].prepare_time().wall + runs[1].render_time().wall, 100, 1.001);
  const auto changes = [&] {
    int count = 0;
    for (std::size_t i = 1; i < world.protocol.size(); ++i) count += world.protocol[i] != world.protocol[i - 1];
    return count;
  }();
  EXPECT_GE(changes, 80) << "about fifty turns each";
}

TEST(Turns, DriftOfTheMachineHitsAllAlike) {
  // Both methods are equal; every pass takes longer than the one before, as on a machine that gets slower.
  World world;
  const Scene scene = fakes::fake_scene();
  std::vector<MethodRun> runs;
  for (const char* name : {"a", "b"}) runs.push_back(make_run(world, scene, name, {.pass_seconds = 0.1}, spp(200)));
  take_turns(
      runs, 0, [](std::size_t, const PointImage&) {}, [](double) {});
  double mean_place[2] = {0, 0};
  for (std::size_t i = 0; i < world.protocol.size(); ++i) {
    mean_place[world.protocol[i] == "b"] += static_cast<double>(i) / 200;
  }
  EXPECT_NEAR(mean_place[0], mean_place[1], 5) << "one after the other would differ by 200";
}

TEST(Turns, EveryRepeatBeginsWithAnotherMethod) {
  const Scene scene = fakes::fake_scene();
  for (std::size_t first = 0; first < 4; ++first) {
    World world;
    std::vector<MethodRun> runs;
    for (const char* name : {"0", "1", "2"}) runs.push_back(make_run(world, scene, name, {}, spp(4)));
    take_turns(
        runs, first, [](std::size_t, const PointImage&) {}, [](double) {});
    EXPECT_EQ(world.protocol.front(), std::to_string(first % 3));
  }
}

TEST(Turns, WorkOfTheReceiverIsChargedToNobody) {
  World world;
  const Scene scene = fakes::fake_scene();
  std::vector<MethodRun> runs;
  for (const char* name : {"a", "b"}) runs.push_back(make_run(world, scene, name, {.pass_seconds = 1}, seconds(16)));
  std::vector<double> walls;
  take_turns(
      runs, 0,
      [&](std::size_t, const PointImage& point) {
        world.spend(1000);  // metrics
        if (point.point.final) walls.push_back(point.point.total().wall);
      },
      [](double) {});
  EXPECT_EQ(walls, (std::vector<double>{16, 16}));
}

}  // namespace
}  // namespace gradslc
