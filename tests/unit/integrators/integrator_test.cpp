#include "integrators/integrator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "core/parallel.h"
#include "integrators/pass_schedule.h"
#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

Film render(const Method& method, const Scene& scene, const RenderSettings& settings, std::uint32_t passes) {
  const auto integrator = method.make();
  integrator->prepare(scene, settings);
  Film film(scene.camera().resolution(), {.gradients = integrator->traits().gradients, .parts = true});
  for (std::uint32_t pass = 0; pass < passes; ++pass) integrator->render_pass(pass, film);
  return film;
}

bool same_bits(const MomentImage& a, const MomentImage& b) {
  const auto& x = a.accumulators();
  const auto& y = b.accumulators();
  return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
}
bool same_moments(const FilmHalf& a, const FilmHalf& b) {
  return same_bits(a.primal, b.primal) && same_bits(a.dx, b.dx) && same_bits(a.dy, b.dy);
}
bool same_bits(const Film& a, const Film& b) {
  for (const int half : {0, 1})
    if (!same_moments(a.half(half), b.half(half)) || a.half(half).part_sums != b.half(half).part_sums) return false;
  return true;
}

const std::vector<Method>& every_method() {
  static const std::vector<Method> k_methods = {
      {"spt", "spt", {}},
      {"vpl", "vpl", {{"vpl/light_paths", 20.0}}},
      {"vpl power", "vpl", {{"vpl/light_paths", 100.0}, {"selection", "power"}}},
      {"lightcuts", "lightcuts", {{"vpl/light_paths", 300.0}}},
      {"slc", "slc", {{"vpl/light_paths", 300.0}}},
      {"slc, cuts by error", "slc", {{"vpl/light_paths", 300.0}, {"cut_error", 0.2}}},
      {"slc tile", "slc", {{"gather", "tile"}, {"vpl/light_paths", 300.0}}},
      {"slc, direct light through VPLs", "slc", {{"vpl/light_paths", 300.0}, {"vpl/direct", true}}},
      {"slc tile, direct light through VPLs",
       "slc",
       {{"gather", "tile"}, {"vpl/light_paths", 300.0}, {"vpl/direct", true}}},
      {"slc tile, adapted rays",
       "slc",
       {{"gather", "tile"},
        {"vpl/light_paths", 300.0},
        {"vpl/kappa", 40.0},
        {"effort/pilot_passes", 2.0},
        {"effort/fewest_rays", 0.1}}},
      {"slc tile, other builder", "slc", {{"gather", "tile"}, {"vpl/light_paths", 300.0}, {"builder", "saoh"}}},
      {"slc, sets of 2", "slc", {{"vpl/light_paths", 300.0}, {"vpl/passes_per_set", 2.0}}},
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

TEST(Integrators, EveryRegisteredOneIsTested) {
  for (const IntegratorEntry& entry : integrator_registry()) {
    bool found = false;
    for (const Method& method : every_method()) found |= method.integrator == entry.name;
    EXPECT_TRUE(found) << entry.name;
  }
}

TEST(Integrators, SameBitsForAnyNumberOfThreads) {
  const Scene scene = test_box({33, 17}, {.mirror = true});
  const int threads_before = thread_count();
  for (const Method& method : every_method()) {
    set_thread_count(1);
    const Film one = render(method, scene, {.max_depth = 5}, 3);
    for (const int threads : {2, 7}) {
      set_thread_count(threads);
      const Film many = render(method, scene, {.max_depth = 5}, 3);
      EXPECT_TRUE(same_bits(one, many)) << method.label << " " << threads;
    }
  }
  set_thread_count(threads_before);
}

/// One pass alone, by an integrator that may have rendered others before.
Film render_pass(Integrator& integrator, const Scene& scene, std::uint32_t pass) {
  Film film(scene.camera().resolution(), {.gradients = integrator.traits().gradients, .parts = true});
  integrator.render_pass(pass, film);
  return film;
}

// A pass is a function of its number: what was rendered before, and in which order, leaves no trace. That of `slc tile`
// depends on pilot passes, which are rendered where they have not been.
TEST(Integrators, PassesDoNotDependOnWhatWasRenderedBefore) {
  const Scene scene = test_box({33, 17}, {.mirror = true});
  constexpr std::uint32_t k_last = 7;
  for (const Method& method : every_method()) {
    const auto in_order = method.make(), shuffled = method.make();
    in_order->prepare(scene, {.max_depth = 5}), shuffled->prepare(scene, {.max_depth = 5});
    std::vector<Film> passes;
    for (std::uint32_t pass = 0; pass <= k_last; ++pass) passes.push_back(render_pass(*in_order, scene, pass));
    for (const std::uint32_t pass : {3u, 1u, 0u, 2u, k_last, 0u})
      EXPECT_TRUE(same_bits(render_pass(*shuffled, scene, pass), passes[pass])) << method.label << " " << pass;
    const auto alone = method.make();
    alone->prepare(scene, {.max_depth = 5});
    EXPECT_TRUE(same_bits(render_pass(*alone, scene, k_last), passes[k_last])) << method.label;
  }
}

// Sobol's later points lie where the pilots' did not: were passes that pilots adapt to from the same sequence, the
// number of their rays would say something of where they are. With one ray always, only the random numbers can differ.
TEST(Integrators, AdaptedPassesAreIndependentOfTheirPilots) {
  const Scene scene = test_box({8, 8});
  const auto last_pass = [&](double pilots) {
    const Method method{"",
                        "slc",
                        {{"gather", "tile"},
                         {"vpl/light_paths", 50.0},
                         {"effort/pilot_passes", pilots},
                         {"effort/fewest_rays", 1.0},
                         {"effort/most_rays", 1.0},
                         {"effort/most_emitter_samples", 1.0},
                         {"effort/adapt_draws", false}}};
    const auto integrator = method.make();
    integrator->prepare(scene, {.max_depth = 4});
    return render_pass(*integrator, scene, 4);
  };
  EXPECT_TRUE(same_bits(last_pass(2), last_pass(4)));
  EXPECT_TRUE(same_bits(last_pass(0), last_pass(5)));  // itself a pilot
  EXPECT_FALSE(same_bits(last_pass(0), last_pass(4)));
}

TEST(Integrators, PreparingAgainForgetsTheFirstTime) {
  const Scene before = closed_furnace(Rgb(0.5f), {9, 20}), after = test_box({33, 17}, {.mirror = true});
  for (const Method& method : every_method()) {
    const auto fresh = method.make(), used = method.make();
    used->prepare(before, {.seed = 1, .max_depth = 5});
    for (std::uint32_t pass = 0; pass < 4; ++pass) render_pass(*used, before, pass);
    fresh->prepare(after, {.seed = 2, .max_depth = 4});
    used->prepare(after, {.seed = 2, .max_depth = 4});
    for (const std::uint32_t pass : {3u, 0u})
      EXPECT_TRUE(same_bits(render_pass(*used, after, pass), render_pass(*fresh, after, pass)))
          << method.label << " " << pass;
  }
}

TEST(Integrators, EveryPixelGetsOneSampleAPassAndPartsSumToTheImage) {
  const Scene scene = test_box({20, 12}, {.mirror = true});
  for (const Method& method : every_method()) {
    const Film film = render(method, scene, {.max_depth = 5}, 3);
    const RgbImage primal = film.primal();
    RgbImage sum(primal.resolution());
    for (int i = 0; i < k_part_count; ++i) {
      const RgbImage part = film.part(static_cast<Part>(i));
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
    }
    for (std::size_t k = 0; k < sum.size(); ++k) {
      const Pixel pixel = primal.resolution().pixel(k);
      EXPECT_EQ(film.half(0).primal.count(pixel) + film.half(1).primal.count(pixel), 3u) << method.label;
      EXPECT_NEAR(luminance(sum[k]), luminance(primal[k]), 1e-5f * (1 + luminance(primal[k]))) << method.label;
    }
  }
}

TEST(Integrators, SeedsAndHalvesDiffer) {
  const Scene scene = test_box({8, 8});
  for (const Method& method : every_method()) {
    const Film a = render(method, scene, {.seed = 1, .max_depth = 4}, 2);
    const Film b = render(method, scene, {.seed = 2, .max_depth = 4}, 2);
    EXPECT_FALSE(same_bits(a.half(0).primal, b.half(0).primal)) << method.label;
    EXPECT_FALSE(same_bits(a.half(0).primal, a.half(1).primal)) << method.label;
  }
}

TEST(Integrators, FullCutIsTheSumOfAllVpls) {
  const Scene scene = test_box({16, 16}, {.mirror = true});
  const Film all = render({"", "vpl", {{"vpl/light_paths", 30.0}}}, scene, {.max_depth = 5}, 1);
  for (const Method& method : {Method{"slc", "slc", {{"vpl/light_paths", 30.0}, {"cut_size", 1000.0}}}}) {
    const Film cut = render(method, scene, {.max_depth = 5}, 1);
    const RgbImage a = all.primal(), b = cut.primal();
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(luminance(a[i]), luminance(b[i]), 2e-5f * (1 + luminance(a[i])));
  }
}

// Where every pixel sees the same radiance, differences are 0 to the last column and row.
TEST(Integrators, ConstantSceneToTheLastPixel) {
  const Scene scene = closed_furnace(Rgb(0.0f), {13, 7});
  for (const Method& method : every_method()) {
    const Film film = render(method, scene, {.max_depth = 4}, 12);
    const RgbImage primal = film.primal();
    for (const Rgb value : primal) EXPECT_EQ(value, Rgb(1)) << method.label;
    if (!film.layers().gradients) continue;
    for (const int half : {0, 1})
      for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 13; ++x) {
          const Pixel p{x, y};
          EXPECT_EQ(film.half(half).dx.mean(p), Rgb());
          EXPECT_EQ(film.half(half).dy.mean(p), Rgb());
          // Pairs that leave the image are not recorded, the others are.
          EXPECT_EQ(film.half(half).dx.count(p) > 0, x + 1 < 13) << method.label << " " << x << "," << y;
          EXPECT_EQ(film.half(half).dy.count(p) > 0, y + 1 < 7) << method.label << " " << x << "," << y;
        }
  }
}

// In one pass a pair's difference is that of two samples of one group: E[dx] = E[I(x+1)] - E[I(x)] is tested with the
// statistical tests; here, that no pair depends on what was hit: counts are those of the partition alone.
TEST(Integrators, RecordedPairsDoNotDependOnTheScene) {
  const Method method{"", "gradslc", {{"vpl/light_paths", 50.0}, {"shift", "random_replay"}}};
  const Film box = render(method, test_box({21, 11}, {.mirror = true}), {.max_depth = 4}, 8);
  const Film furnace = render(method, closed_furnace(Rgb(0.5f), {21, 11}), {.max_depth = 4}, 8);
  for (const int half : {0, 1})
    for (std::size_t i = 0; i < box.resolution().pixels(); ++i) {
      const Pixel p = box.resolution().pixel(i);
      EXPECT_EQ(box.half(half).dx.count(p), furnace.half(half).dx.count(p));
      EXPECT_EQ(box.half(half).dy.count(p), furnace.half(half).dy.count(p));
    }
}

TEST(Integrators, SceneWithoutLightIsBlack) {
  SceneDescription description;
  description.materials = {diffuse_material(Rgb(0.5f))};
  description.meshes = {inward_box({-1, -1, -1}, {1, 1, 1}, 0)};
  description.camera = camera_at({6, 5}, {0, 0, 0}, {0, 0, 1}, 60);
  const Scene scene(std::move(description));
  for (const Method& method : every_method())
    for (const Rgb value : render(method, scene, {.max_depth = 5}, 2).primal()) EXPECT_EQ(value, Rgb()) << method.label;
}

TEST(Integrators, ViewIntoEmptySpaceIsBlack) {
  SceneDescription description;
  description.materials = {diffuse_material(Rgb(0.5f))};
  description.area_lights = {{Rgb(1)}};
  description.meshes = {quad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, 0), quad({-1, -1, -1}, {0, 2, 0}, {2, 0, 0}, 0)};
  description.meshes[1].area_light = 0;
  description.camera = camera_at({6, 5}, {0, 0, 0}, {0, 0, 1}, 60);
  const Scene scene(std::move(description));
  for (const Method& method : every_method())
    for (const Rgb value : render(method, scene, {.max_depth = 5}, 4).primal()) EXPECT_EQ(value, Rgb()) << method.label;
}

TEST(Integrators, ImagesOfOneColumnRowOrPixel) {
  for (const Resolution resolution : {Resolution{1, 1}, {1, 19}, {19, 1}})
    for (const Method& method : every_method()) {
      const Film film = render(method, test_box(resolution), {.max_depth = 4}, 4);
      EXPECT_EQ(film.invalid_samples(), 0u) << method.label;
      EXPECT_GT(luminance(film.primal()[resolution.pixels() / 2]), 0) << method.label;
    }
}

TEST(Integrators, ShallowDepthsOfEveryMethod) {
  const Scene scene = test_box({8, 8}, {.mirror = true});
  for (const Method& method : every_method())
    for (const int max_depth : {1, 2, 3}) {
      const Film film = render(method, scene, {.max_depth = max_depth}, 2);
      EXPECT_EQ(film.invalid_samples(), 0u);
      if (max_depth > 2) continue;
      for (const Rgb value : film.part(Part::vpl)) EXPECT_EQ(value, Rgb()) << method.label << " " << max_depth;
    }
}

// Behind a mirror x has two camera edges: a VPL of the first bounce makes four. Such light is there at depth 4, not
// at 3.
TEST(Integrators, VplsBeyondTheDepthLimitAreLeftOut) {
  const Scene scene = test_box({16, 16}, {.mirror = true});
  Image<char> sees_mirror(scene.camera().resolution(), 0);
  for (std::size_t i = 0; i < sees_mirror.size(); ++i) {
    const Pixel pixel = scene.camera().resolution().pixel(i);
    bool all = true;  // corners of the pixel: whatever the jitter, a mirror is seen first
    for (const Vec2 corner : {Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}, Vec2{1, 1}}) {
      const Vec2 position = Vec2{static_cast<float>(pixel.x), static_cast<float>(pixel.y)} + corner;
      const auto hit = scene.intersect(scene.camera().generate_ray(position));
      all = all && hit && !scene.shade(*hit, {0, 0, -1}).bsdf.has(LobeSelection().only_connectable());
    }
    sees_mirror[i] = all;
  }
  for (const Method& method : every_method()) {
    if (method.integrator == "spt" || method.integrator == "gpt") continue;
    float at_depth[5] = {};
    for (const int max_depth : {3, 4}) {
      const RgbImage vpl = render(method, scene, {.max_depth = max_depth}, 2).part(Part::vpl);
      for (std::size_t i = 0; i < vpl.size(); ++i)
        if (sees_mirror[i]) at_depth[max_depth] += luminance(vpl[i]);
    }
    EXPECT_EQ(at_depth[3], 0) << method.label;
    EXPECT_GT(at_depth[4], 0) << method.label;
  }
}

TEST(Integrators, TraitsSayWhatIsBiasedOrTruncated) {
  const Scene scene = test_box({4, 4});
  const auto traits = [&](std::map<std::string, ParameterValue> parameters) {
    parameters["vpl/light_paths"] = 20.0;
    const auto integrator = Method{"", "slc", parameters}.make();
    integrator->prepare(scene, {.max_depth = 5});
    return integrator->traits();
  };
  EXPECT_FALSE(traits({}).biased);
  EXPECT_FALSE(traits({}).truncated);
  EXPECT_FALSE(traits({}).one_set);
  EXPECT_TRUE(traits({{"vpl/bounding", "clamp"}}).biased);
  EXPECT_TRUE(traits({{"vpl/max_bounces", 2.0}}).truncated);
  EXPECT_FALSE(traits({{"vpl/max_bounces", 3.0}}).truncated);
  EXPECT_TRUE(traits({{"vpl/passes_per_set", 0.0}}).one_set);
}

/// The same bits, but for parts so dark (some 1e-34 beside 1) that they are rounded as denormal numbers at one scale
/// only.
bool same_but_for_underflow(const Film& a, const Film& b) {
  constexpr float k_dark = 1e-28f;
  for (const int half : {0, 1}) {
    if (!same_moments(a.half(half), b.half(half))) return false;
    for (std::size_t part = 0; part < a.half(half).part_sums.size(); ++part)
      for (std::size_t i = 0; i < a.resolution().pixels(); ++i) {
        const Pixel pixel = a.resolution().pixel(i);
        const Rgb x = a.half(half).part_sums[part][pixel], y = b.half(half).part_sums[part][pixel];
        if (x != y && std::max(max_channel(x), max_channel(y)) > k_dark) return false;
      }
  }
  return true;
}

// The same scene in millimetres and in kilometres gives the same image (DESIGN 5), to the last bit, since powers of two
// scale without rounding.
TEST(Integrators, ImageDoesNotDependOnTheUnitOfLength) {
  constexpr Resolution k_resolution{10, 10};
  const auto diffuse = [&](float scale) { return test_box(k_resolution, {.mirror = true, .scale = scale}); };
  const auto glossy = [&](float scale) { return glossy_box(k_resolution, GlossyLight::lamp, scale); };
  for (const std::function<Scene(float)>& at_scale : {std::function<Scene(float)>(diffuse), {glossy}}) {
    const Scene metres = at_scale(1), kilometres = at_scale(0x1p-10f), millimetres = at_scale(0x1p10f);
    for (const Method& method : every_method()) {
      const RenderSettings settings{.max_depth = 4};
      const Film expected = render(method, metres, settings, 3);
      EXPECT_TRUE(same_but_for_underflow(expected, render(method, kilometres, settings, 3))) << method.label;
      EXPECT_TRUE(same_but_for_underflow(expected, render(method, millimetres, settings, 3))) << method.label;
    }
  }
}

struct SetOfVpls {
  double planned, made, bound;
};
SetOfVpls set_of_vpls(const Scene& scene, const RenderSettings& settings, bool direct) {
  const auto slc = Method{"", "slc", {{"vpl/light_paths", 400.0}, {"vpl/direct", direct}}}.make();
  SetOfVpls set{slc->plan_memory(scene, settings).vpls, 0, 0};
  slc->prepare(scene, settings);
  Film film(scene.camera().resolution(), {});
  slc->render_pass(0, film);
  for (const auto& [name, value] : slc->statistics().counters) {
    if (name == "vpls_per_set") set.made = value;
    if (name == "vpl_bound") set.bound = value;
  }
  return set;
}

// A path leaves one on the lamp where D = p + 1 + c can count: always as direct light; as indirect light only behind a
// mirror or a crossing. The bound stays that of the walls' density.
TEST(DirectLightThroughVpls, HasVplsOnEmittersWhereTheyCanCount) {
  constexpr Components k_indirect{.emission = false, .direct = false};
  for (const bool mirror : {false, true}) {
    const Scene scene = mirror ? test_box({4, 4}, {.mirror = true}) : closed_furnace(Rgb(0.5f), {4, 4});
    for (const bool only_indirect : {false, true}) {
      const RenderSettings settings{.max_depth = 4, .components = only_indirect ? k_indirect : Components{}};
      const SetOfVpls without = set_of_vpls(scene, settings, false), with = set_of_vpls(scene, settings, true);
      const double added = only_indirect && !mirror ? 0 : 400;
      EXPECT_EQ(with.made, without.made + added) << mirror << only_indirect;
      EXPECT_EQ(with.planned, without.planned + added) << mirror << only_indirect;
      EXPECT_EQ(with.bound, without.bound) << mirror << only_indirect;
    }
  }
}

// Without indirect light there are no others, and the bound is that of the lamp's density.
TEST(DirectLightThroughVpls, HasOnlyVplsOnEmittersWhereNoOthersCount) {
  const Scene scene = test_box({4, 4});
  const RenderSettings only_direct{.max_depth = 5, .components = {.indirect = false}};
  for (const RenderSettings& settings : {only_direct, RenderSettings{.max_depth = 2}}) {
    const SetOfVpls set = set_of_vpls(scene, settings, true);
    EXPECT_EQ(set.made, 400);
    EXPECT_GT(set.bound, set_of_vpls(scene, {.max_depth = 5}, true).bound);
    EXPECT_LT(set.bound, 1e6);
  }
  EXPECT_EQ(set_of_vpls(scene, {.max_depth = 1}, true).made, 0);
}

TEST(PassSchedule, HalvesAlternateBySet) {
  for (const std::uint32_t per_set : {1u, 3u}) {
    std::uint32_t samples[2] = {};
    for (std::uint32_t pass = 0; pass < 24; ++pass) {
      const PassSlot slot = pass_slot(pass, per_set);
      EXPECT_EQ(slot.half, static_cast<int>(pass / per_set % 2));
      EXPECT_EQ(slot.sample, samples[slot.half]++) << "samples of a half are counted without gaps";
      EXPECT_EQ(slot.set, slot.sample / per_set);
      EXPECT_EQ(slot.closes_set, pass % per_set == per_set - 1);
    }
  }
  EXPECT_EQ(pass_slot(7, 0).set, 0u);
  EXPECT_EQ(pass_slot(7, 0).half, 1);
  EXPECT_EQ(pass_slot(7, 0).sample, 3u);
}

}  // namespace
}  // namespace gradslc
