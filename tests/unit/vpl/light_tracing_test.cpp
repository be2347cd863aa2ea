#include "vpl/light_tracing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "scene/lights/point.h"
#include "support/render/scenes.h"
#include "support/statistics.h"

namespace gradslc {
namespace {

LightTracingSettings settings_for(std::int64_t paths, int bounces, std::uint64_t seed = 1) {
  return {
      .light_paths = paths, .max_bounces = bounces, .lobes = {}, .sampler = SamplerKind::sobol, .seed = seed, .set = 0};
}

bool same_bits(std::span<const Vpl> a, std::span<const Vpl> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vpl)) == 0;
}

// In a closed furnace every particle reaches a wall: the flux that the k-th vertices reflect is power * albedo^k.
// False-alarm rate 0.1 %.
TEST(LightTracing, ConservesEnergyAtEveryBounce) {
  constexpr float k_albedo = 0.6f;
  constexpr int k_bounces = 4, k_runs = 100;
  const Scene scene = closed_furnace(Rgb(k_albedo), {4, 4});
  std::vector<Moments> reflected(k_bounces + 1);
  for (int run = 0; run < k_runs; ++run) {
    std::vector<double> sum(k_bounces + 1);
    for (const Vpl& vpl : trace_vpls(scene, settings_for(100, k_bounces, static_cast<std::uint64_t>(run))).vpls)
      sum[vpl.vertex] += static_cast<double>(vpl.flux.g);
    for (std::size_t k = 1; k < sum.size(); ++k) reflected[k].add(sum[k]);
  }
  const double power = static_cast<double>(scene.emitters().power().g);
  EXPECT_NEAR(power, 24 * 3.14159265, 1e-3);
  EXPECT_NEAR(reflected[1].mean(), 0.6 * power, 1e-3 * power);  // no choice is left to chance before the first vertex
  for (std::size_t k = 2; k <= k_bounces; ++k)
    EXPECT_GT(reflected[k].p_value(power * std::pow(0.6, static_cast<double>(k))), sidak(0.001, k_bounces - 1)) << k;
}

/// Paths that start on an area light, and on none: a point light of the same power.
Scene lamp_and_point() {
  SceneDescription description;
  description.materials = {diffuse_material(Rgb(0.5f))};
  description.area_lights = {{Rgb(3)}};
  TriangleMesh lamp = quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, 0);  // faces down
  lamp.area_light = 0;
  description.meshes = {lamp, inward_box({-2, -2, -2}, {2, 2, 2}, 0)};
  description.lights = {std::make_shared<const PointLight>(Point3{1, 0, 1}, Rgb(0.75f))};
  return Scene(std::move(description));
}

TEST(LightTracing, LeavesVplsOnAreaLightsIfAskedFor) {
  const Scene scene = lamp_and_point();
  constexpr int k_paths = 4096;
  LightTracingSettings settings = settings_for(k_paths, 3);
  const VplSet without = trace_vpls(scene, settings);
  settings.on_emitters = true;
  const VplSet with = trace_vpls(scene, settings);

  std::vector<Vpl> on_lamp, others;
  for (const Vpl& vpl : with.vpls) (vpl.vertex == 0 ? on_lamp : others).push_back(vpl);
  EXPECT_TRUE(same_bits(others, without.vpls)) << "they must not change the rest";
  EXPECT_NEAR(static_cast<double>(on_lamp.size()), k_paths / 2, 2) << "half of the power, stratified";
  double flux = 0;
  for (const Vpl& vpl : on_lamp) {
    flux += static_cast<double>(vpl.flux.g);
    EXPECT_TRUE(vpl.is_lambert());
    EXPECT_EQ(vpl.max_pi_f, 1);
    EXPECT_LT(std::abs(vpl.position.x), 0.5f);
    EXPECT_NEAR(vpl.position.y, 1, 1e-6f);
    EXPECT_LT(vpl.geometric_normal.decode().y, -0.9999f);
    EXPECT_EQ(vpl.shading_normal, vpl.geometric_normal);
  }
  EXPECT_NEAR(flux, 3 * std::numbers::pi, 0.01);

  settings.max_bounces = 0;
  EXPECT_TRUE(same_bits(trace_vpls(scene, settings).vpls, on_lamp));
}

TEST(LightTracing, StopsAfterMaxBounces) {
  const Scene scene = closed_furnace(Rgb(0.9f), {4, 4});
  std::uint32_t deepest = 0;
  for (const Vpl& vpl : trace_vpls(scene, settings_for(2000, 3)).vpls)
    deepest = std::max<std::uint32_t>(deepest, vpl.vertex);
  EXPECT_EQ(deepest, 3u);
}

TEST(LightTracing, SameBitsForAnyNumberOfThreads) {
  const Scene scene = test_box({4, 4});
  const int threads_before = thread_count();
  set_thread_count(1);
  const VplSet one = trace_vpls(scene, settings_for(5000, 5));
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    const VplSet many = trace_vpls(scene, settings_for(5000, 5));
    EXPECT_TRUE(same_bits(one.vpls, many.vpls)) << threads;
    EXPECT_EQ(one.rays, many.rays);
  }
  set_thread_count(threads_before);
}

// Rounds of 2^18 paths are appended one after another.
TEST(LightTracing, ASetOfSeveralRoundsIsInTheOrderOfItsPaths) {
  const Scene scene = test_box({4, 4});
  constexpr std::int64_t k_paths = (1 << 18) + 3000;
  const VplSet all = trace_vpls(scene, settings_for(k_paths, 1));
  const VplSet first = trace_vpls(scene, settings_for(5000, 1));
  ASSERT_LT(first.vpls.size(), all.vpls.size());
  for (std::size_t i = 0; i < first.vpls.size(); ++i) ASSERT_EQ(all.vpls[i].position, first.vpls[i].position);
  LightTracingSettings later = settings_for(5000, 1);
  later.set = 1;
  const VplSet second = trace_vpls(scene, later);
  for (std::size_t i = 0; i < second.vpls.size(); ++i)
    ASSERT_EQ(all.vpls[first.vpls.size() + i].position, second.vpls[i].position);
  EXPECT_EQ(all.rays, static_cast<std::uint64_t>(k_paths));
}

TEST(LightTracing, SetsContinueTheSequenceAndDiffer) {
  const Scene scene = test_box({4, 4});
  LightTracingSettings settings = settings_for(512, 2);
  const VplSet first = trace_vpls(scene, settings);
  settings.set = 1;
  EXPECT_FALSE(same_bits(first.vpls, trace_vpls(scene, settings).vpls));
}

TEST(LightTracing, LeavesNoVplOnMirrorsNorOnBlackWalls) {
  const Scene scene = test_box({4, 4}, {.mirror = true});
  const auto set = trace_vpls(scene, settings_for(2000, 5));
  ASSERT_FALSE(set.vpls.empty());
  for (const Vpl& vpl : set.vpls) {
    EXPECT_GT(vpl.max_pi_f, 0);
    const bool on_back_wall = vpl.position.z > 0.999f && std::abs(vpl.geometric_normal.decode().z) > 0.9f;
    EXPECT_FALSE(on_back_wall) << "the back wall is a mirror";
  }
}

TEST(LightTracing, LiesOnTheLitSide) {
  const Scene scene = test_box({4, 4});
  for (const Vpl& vpl : trace_vpls(scene, settings_for(2000, 4)).vpls)
    EXPECT_GT(dot(vpl.geometric_normal.decode(), vpl.incoming.decode()), -1e-3f);
}

TEST(LightTracing, NoEmittersNoVpls) {
  SceneDescription description;
  description.materials = {diffuse_material(Rgb(0.5f))};
  description.meshes = {inward_box({-1, -1, -1}, {1, 1, 1}, 0)};
  EXPECT_TRUE(trace_vpls(Scene(std::move(description)), settings_for(100, 3)).vpls.empty());
}

}  // namespace
}  // namespace gradslc
