#include "integrators/path_log.h"

#include <gtest/gtest.h>

#include <cstring>

#include "integrators/integrator.h"
#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

const std::vector<Method>& logged_methods() {
  static const std::vector<Method> k_methods = {
      {"spt", "spt", {}},
      {"vpl", "vpl", {{"vpl/light_paths", 20.0}}},
      {"vpl power", "vpl", {{"vpl/light_paths", 100.0}, {"selection", "power"}}},
      {"lightcuts", "lightcuts", {{"vpl/light_paths", 300.0}}},
      {"slc", "slc", {{"vpl/light_paths", 300.0}, {"vpl/passes_per_set", 2.0}}},
      {"slc tile", "slc", {{"gather", "tile"}, {"tile/size", 5.0}, {"vpl/light_paths", 300.0}}},
      {"slc tile, one ray", "slc", {{"gather", "tile"}, {"effort/pilot_passes", 0.0}, {"vpl/light_paths", 300.0}}},
      {"slc tile, most light by compensation rays",
       "slc",
       {{"gather", "tile"}, {"vpl/bound", 0.03}, {"effort/pilot_passes", 2.0}, {"vpl/light_paths", 300.0}}},
      {"slc tile, direct light through VPLs",
       "slc",
       {{"gather", "tile"}, {"vpl/direct", true}, {"vpl/light_paths", 300.0}}},
      {"gradslc reconnection", "gradslc", {{"vpl/light_paths", 300.0}}},
      {"gradslc symmetric", "gradslc", {{"vpl/light_paths", 300.0}, {"stencil", "symmetric"}}},
      {"gradslc random replay", "gradslc", {{"vpl/light_paths", 300.0}, {"shift", "random_replay"}}},
      {"gradslc block", "gradslc", {{"vpl/light_paths", 300.0}, {"shift", "block"}, {"block/width", 3.0}}},
      {"gradslc block, tile",
       "gradslc",
       {{"vpl/light_paths", 300.0}, {"shift", "block"}, {"gather", "tile"}, {"tile/size", 8.0}}},
      {"gradslc reconnection, tile", "gradslc", {{"vpl/light_paths", 300.0}, {"gather", "tile"}, {"tile/size", 8.0}}},
      {"gradslc symmetric, tile",
       "gradslc",
       {{"vpl/light_paths", 300.0}, {"gather", "tile"}, {"tile/size", 8.0}, {"stencil", "symmetric"}}},
      {"gradslc random replay, tile",
       "gradslc",
       {{"vpl/light_paths", 300.0}, {"gather", "tile"}, {"tile/size", 4.0}, {"shift", "random_replay"}}},
      {"gpt", "gpt", {}},
      {"gpt random replay", "gpt", {{"shift", "random_replay"}}},
  };
  return k_methods;
}

bool has_vpls(const Method& method) { return method.integrator != "spt" && method.integrator != "gpt"; }

struct Rendered {
  std::unique_ptr<Integrator> integrator;
  Film film;
};
Rendered render(const Method& method, const Scene& scene, FilmLayers layers, std::uint32_t first_pass,
                std::uint32_t end_pass, const Probe& probe = {}) {
  auto integrator = method.make();
  integrator->prepare(scene, {.max_depth = 5});
  integrator->set_probe(probe);
  layers.gradients = integrator->traits().gradients;
  Film film(scene.camera().resolution(), layers);
  for (std::uint32_t pass = first_pass; pass < end_pass; ++pass) integrator->render_pass(pass, film);
  return {std::move(integrator), std::move(film)};
}

bool same_bits(const MomentImage& a, const MomentImage& b) {
  const auto& x = a.accumulators();
  const auto& y = b.accumulators();
  return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
}

/// Path tracing alone takes other steps where parts are told apart.
std::vector<bool> part_choices(const Method& method) {
  return method.integrator == "spt" ? std::vector<bool>{false, true} : std::vector<bool>{true};
}

std::vector<Scene> logged_scenes() {
  std::vector<Scene> scenes;
  scenes.push_back(test_box({9, 7}, {.mirror = true}));
  scenes.push_back(glossy_box({9, 7}, GlossyLight::sky));
  return scenes;
}

TEST(DebugImages, LeaveTheImagesBitsAsTheyAre) {
  for (const Scene& scene : logged_scenes())
    for (const Method& method : logged_methods())
      for (const bool parts : part_choices(method)) {
        const Film plain = render(method, scene, {.parts = parts}, 0, 6).film;
        const Film debug = render(method, scene, {.parts = parts, .debug = true}, 0, 6).film;
        for (const int half : {0, 1}) {
          EXPECT_TRUE(same_bits(plain.half(half).primal, debug.half(half).primal)) << method.label;
          EXPECT_TRUE(same_bits(plain.half(half).dx, debug.half(half).dx)) << method.label;
          EXPECT_EQ(plain.half(half).part_sums, debug.half(half).part_sums) << method.label;
        }
      }
}

TEST(DebugImages, AccountForAllRaysAndNodes) {
  const Scene scene = glossy_box({9, 7});
  for (const Method& method : logged_methods()) {
    const Rendered rendered = render(method, scene, {.debug = true}, 0, 6);
    const DebugImage debug = rendered.film.debug();
    double rays = 0, nodes = 0, cut_size = 0, failed_shifts = 0;
    for (std::size_t i = 0; i < scene.camera().resolution().pixels(); ++i) {
      EXPECT_EQ(debug[i].samples, 6u) << method.label;
      rays += debug[i].rays, nodes += debug[i].node_evaluations, cut_size += debug[i].cut_size;
      failed_shifts += debug[i].failed_shifts;
    }
    const IntegratorStatistics statistics = rendered.integrator->statistics();
    double light_rays = 0, expected_nodes = 0, expected_failures = 0;
    for (const IntegratorStatistics::Counter& counter : statistics.counters) {
      if (counter.name == "light_rays") light_rays = counter.value;
      if (counter.name == "node_evaluations") expected_nodes = counter.value;
      if (counter.name.starts_with("failed_shifts_")) expected_failures += counter.value;
    }
    EXPECT_EQ(rays + light_rays, static_cast<double>(statistics.rays)) << method.label;
    EXPECT_NEAR(nodes, expected_nodes, 1e-5 * expected_nodes) << method.label;
    EXPECT_EQ(cut_size > 0, has_vpls(method)) << method.label;
    EXPECT_EQ(failed_shifts, expected_failures) << method.label;
    EXPECT_EQ(failed_shifts > 0, method.label == "gpt") << method.label;
  }
}

TEST(DebugImages, FindTheLargestContributionOfAllPasses) {
  const Scene scene = test_box({9, 7}, {.mirror = true});
  for (const Method& method : logged_methods()) {
    const DebugImage all = render(method, scene, {.parts = true, .debug = true}, 0, 6).film.debug();
    const std::optional<Pixel> pixel = pixel_of_largest_contribution(all);
    ASSERT_TRUE(pixel) << method.label;
    const Largest largest = all[*pixel].contribution;
    PathLog log;
    const auto pass = static_cast<std::uint32_t>(largest.pass);
    render(method, scene, {.parts = true}, pass, pass + 1, {*pixel, pass, &log});
    EXPECT_EQ(log.sample().contribution, largest) << method.label;
    float most = 0;
    for (const PathLog::Entry& entry : log.entries()) most = std::max(most, luminance(entry.value));
    EXPECT_FLOAT_EQ(most, largest.luminance) << method.label;
  }
}

// Of whole runs, so that a probe that leaves out pixels, tiles or pilot passes cannot agree with itself alone.
TEST(PathLog, HoldsWhatTheFilmOfThatPassRecords) {
  for (const Scene& scene : logged_scenes())
    for (const Method& method : logged_methods())
      for (const std::uint32_t pass : {1u, 5u})
        for (const bool parts : part_choices(method)) {
          const Film film = render(method, scene, {.parts = parts}, pass, pass + 1).film;
          for (const Pixel pixel : {Pixel{0, 0}, Pixel{4, 3}, Pixel{8, 6}}) {
            PathLog log;
            render(method, scene, {.parts = parts}, pass, pass + 1, {pixel, pass, &log});
            const Rgb recorded = film.primal()[pixel];
            EXPECT_EQ(log.sample().value, recorded) << method.label;
            double sum[3] = {};
            for (const PathLog::Entry& entry : log.entries())
              for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(entry.value[c]);
            for (int c = 0; c < 3; ++c)
              EXPECT_NEAR(sum[c], recorded[c], 1e-5 * static_cast<double>(recorded[c])) << method.label << pass;
          }
        }
}

TEST(PathLog, ConnectionsAreTheProductOfTheirFactors) {
  const Scene scene = glossy_box({9, 7});
  int behind_rays = 0;
  for (const Method& method : logged_methods()) {
    int connections = 0, next_events = 0, rays = 0;
    for (const auto& [pixel, pass] : {std::pair(Pixel{4, 3}, 1u),
                                      {Pixel{4, 3}, 5u},
                                      {Pixel{2, 6}, 5u},
                                      {Pixel{3, 5}, 1u},
                                      {Pixel{6, 5}, 1u},
                                      {Pixel{5, 4}, 1u}}) {
      PathLog log;
      render(method, scene, {.parts = true}, pass, pass + 1, {pixel, pass, &log});
      Rgb of_pixel(1), throughput(1);
      float groups = 1;
      bool behind = false;  // a compensation ray, whose light is multiplied by `scale`
      float scale = 1;
      for (const auto& [what, value, part] : log.entries()) {
        if (const auto* group = std::get_if<happening::Group>(&what)) groups = static_cast<float>(group->groups);
        if (const auto* ray = std::get_if<happening::CompensationRay>(&what)) behind = true, scale = ray->scale;
        if (const auto* gather = std::get_if<happening::Gather>(&what)) {
          throughput = gather->throughput * scale;
          if (!behind) of_pixel = throughput;
        }
        if (std::holds_alternative<happening::CompensationEnd>(what)) {
          behind = false, scale = 1;
          throughput = of_pixel;
        }
        next_events += std::holds_alternative<happening::NextEvent>(what);
        rays += std::holds_alternative<happening::CompensationRay>(what);
        const auto* c = std::get_if<happening::VplConnection>(&what);
        if (!c) continue;
        ++connections;
        EXPECT_EQ(part, behind ? Part::compensation : c->vertex == 0 ? Part::direct : Part::vpl);
        behind_rays += behind;
        EXPECT_TRUE(c->weight > 0 || (behind && c->weight == 0));  // bounding may have left nothing over
        EXPECT_GT(c->bounded_weight, 0);
        EXPECT_LE(c->bounded_weight, 1);
        EXPECT_LE(c->edges, 5);
        const Rgb product = throughput * c->unshadowed * c->transmittance * (c->weight / groups);
        for (int channel = 0; channel < 3; ++channel)
          EXPECT_NEAR(value[channel], product[channel], 1e-6f * (product[channel] + 1e-6f)) << method.label;
      }
    }
    EXPECT_EQ(connections > 0, has_vpls(method)) << method.label;
    EXPECT_EQ(rays > 0, has_vpls(method)) << method.label;
    if (!method.parameters.contains("vpl/direct")) {
      EXPECT_GT(next_events, 0) << method.label;
    }
  }
  EXPECT_GT(behind_rays, 0);
}

TEST(PathLog, ScalesWhatItAppends) {
  PathLog part, log;
  part.start(3, true), log.start(3, true);
  part.add_rays(5);
  part.add_selection(4, 6);
  part.add_vpl({.vertex = 1, .unshadowed = Rgb(8), .transmittance = Rgb(0.5f), .weight = 2});
  log.append(part, 0.25f);
  log.append(part, 0.5f);
  EXPECT_EQ(log.sample().rays, 10u);
  EXPECT_EQ(log.sample().cut_size, 3);
  EXPECT_EQ(log.sample().node_evaluations, 12);
  EXPECT_FLOAT_EQ(log.sample().contribution.luminance, 4);
  EXPECT_EQ(log.sample().contribution.part, Part::vpl);
  ASSERT_EQ(log.entries().size(), 2u);
  EXPECT_EQ(log.entries()[0].value, Rgb(2));
  EXPECT_EQ(log.entries()[1].value, Rgb(4));
}

TEST(PathLog, ScalesCompensationRaysByTheirMeanNumber) {
  PathLog log;
  log.start(0, true);
  PartValues brought;
  brought[Part::compensation] = Rgb(3), brought[Part::specular] = Rgb(1);
  log.begin_compensation_ray(0, 0.5f);
  log.add(happening::EmitterHit{}, brought, true);
  log.end_compensation_rays();
  log.add(happening::EmitterHit{}, brought, false);
  ASSERT_EQ(log.entries().size(), 4u);
  EXPECT_EQ(log.entries()[1].value, Rgb(2));
  EXPECT_EQ(log.entries()[1].part, Part::compensation);
  EXPECT_EQ(log.entries()[3].value, Rgb(4));
  EXPECT_EQ(log.entries()[3].part, std::nullopt);
}

}  // namespace
}  // namespace gradslc
