// Every way to select VPLs on sets that are odd: none, one, few, all at one place, all black, around the receiver.
// Always finite, and right by the sum over all VPLs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "integrators/cut_gather.h"
#include "integrators/tile_gather.h"
#include "lighttree/estimated_cut.h"
#include "support/render/method.h"
#include "support/render/scenes.h"
#include "unit/lighttree/random_vpls.h"

namespace gradslc {
namespace {

const RenderSettings& settings() {
  static const RenderSettings k_settings{.max_depth = 5, .sampler = SamplerKind::independent};
  return k_settings;
}
PathContext context(const Scene& scene, std::uint32_t sample) {
  return {scene, settings(), LobeSelection(), SampleStream(settings().sampler, 1, 0, sample)};
}

/// Where neighbouring pixels gather.
std::vector<PathVertex> gather_points(const Scene& scene) {
  std::vector<PathVertex> points;
  PathContext path = context(scene, 0);
  for (const Vec2 position : {Vec2{5, 3}, Vec2{6, 3}, Vec2{5, 4}})
    if (const auto x = trace_camera_prefix(path, position).gather) points.push_back(*x);
  return points;
}

struct OddSet {
  std::string name;
  VplSet set;
};

std::vector<OddSet> odd_sets(Point3 receiver) {
  TestRandom random(1);
  std::vector<OddSet> sets = {{"none", {}}};
  for (const std::size_t count : {1u, 2u, 3u, 9u, 65u, 513u})  // 2^k + 1: the last node of a level has one child
    sets.push_back({std::to_string(count), random_vpls(random, count, 0.8f)});
  VplSet some = random_vpls(random, 17, 0.8f);
  const auto changed = [&](const std::string& name, const std::function<void(Vpl&)>& change) {
    sets.push_back({name, some});
    for (Vpl& vpl : sets.back().set.vpls) change(vpl);
  };
  changed("one place", [](Vpl& vpl) { vpl.position = {0.1f, -0.2f, 0.3f}; });
  changed("on the receiver", [&](Vpl& vpl) { vpl.position = receiver; });
  changed("black", [](Vpl& vpl) { vpl.flux = Rgb(); });
  changed("around the receiver", [&](Vpl& vpl) { vpl.position = receiver + 0.3f * (vpl.position - Point3{}); });
  changed("one colour each", [&](Vpl& vpl) { vpl.flux = random.below(2) == 0 ? Rgb(1, 0, 0) : Rgb(0, 0, 1); });
  VplSet one_lit = some;
  for (std::size_t i = 1; i < some.vpls.size(); ++i) one_lit.vpls[i].flux = Rgb();
  sets.push_back({"all but one black", one_lit});
  VplSet same;
  for (int i = 0; i < 65; ++i) same.vpls.push_back(some.vpls[0]);
  sets.push_back({"one VPL 65 times", same});
  return sets;
}

struct OddCase {
  const Scene& scene;
  LightTree tree;
  std::vector<PathVertex> points;
  float bound;

  VplView vpls() const { return {scene.materials(), tree.set}; }
  std::vector<Receiver> receivers() const {
    std::vector<Receiver> receivers;
    for (const PathVertex& x : points) receivers.push_back(make_receiver({x, LobeSelection()}));
    return receivers;
  }
  Rgb contribution(const PathVertex& x, const Vpl& vpl) const {
    const GatherPoint point{x, LobeSelection()};
    const Rgb value = unshadowed_contribution(point, vpls(), vpl, bound);
    return is_black(value) || scene.occluded(connection_segment(point, vpl)) ? Rgb() : value;
  }
  double exact(const PathVertex& x) const {
    double sum = 0;
    for (const Vpl& vpl : tree.set.vpls) sum += static_cast<double>(luminance(contribution(x, vpl)));
    return sum;
  }
};

void for_each_odd_case(const std::function<void(const OddCase&)>& check) {
  const Scene scene = test_box({12, 12});
  const std::vector<PathVertex> points = gather_points(scene);
  ASSERT_EQ(points.size(), 3u);
  for (const OddSet& odd : odd_sets(points[0].point.position))
    for (const BuilderEntry& builder : builder_registry())
      for (const float bound : {k_infinity, 2.0f}) {
        SCOPED_TRACE(odd.name + ", " + builder.name + (bound < k_infinity ? ", bounded" : ", not bounded"));
        check({scene, builder.build(odd.set), points, bound});
      }
}

TEST(OddVplSets, FullCutsOfSlcAndLightcutsAreExact) {
  for_each_odd_case([](const OddCase& c) {
    const PathVertex& x = c.points[0];
    const double exact = c.exact(x);
    ASSERT_TRUE(std::isfinite(exact));
    PathContext path = context(c.scene, 0);
    const Receiver receiver = make_receiver({x, LobeSelection()});
    CutSelector selector(c.tree, {.size = 1000}, c.bound);
    const Rgb slc = gather_chosen(path, x, c.tree, selector.select({&receiver, 1}, path.random), c.bound).total();
    EXPECT_NEAR(static_cast<double>(luminance(slc)), exact, 1e-5 * exact);

    for (const ErrorLimits limits : {ErrorLimits{0, 1000}, ErrorLimits{0.02f, 1000}, ErrorLimits{0, 1}}) {
      EstimatedCut cut;
      find_estimated_cut(
          c.tree, Representatives(c.tree, 1), receiver, c.bound, limits,
          [&](std::uint32_t vpl) { return c.contribution(x, c.tree.set.vpls[vpl]); }, cut);
      ASSERT_TRUE(is_finite(cut.total()));
      if (limits.most_clusters == 1) continue;
      // The ratio limits each cluster's error by itself; those of several are of either sign.
      const double ratio =
          static_cast<double>(limits.error_ratio) * std::sqrt(static_cast<double>(cut.clusters.size()));
      EXPECT_NEAR(static_cast<double>(luminance(cut.total())), exact, (1e-5 + ratio) * exact);
    }
  });
}

/// z-tests of means over random numbers, of a whole test together.
class Means {
 public:
  void add(const std::string& what, const Moments& moments, double expected) {
    results_.push_back({what, moments.p_value(expected), moments.mean(), expected});
  }
  /// False-alarm rate 0.1 % for all together.
  void expect_right() const {
    for (const Result& r : results_)
      EXPECT_GT(r.p_value, sidak(0.001, results_.size())) << r.what << ": " << r.mean << ", not " << r.expected;
  }

 private:
  struct Result {
    std::string what;
    double p_value, mean, expected;
  };
  std::vector<Result> results_;
};

// Shared laws over three receivers as gradslc has them, one receiver as slc, and slc's tiles. Without bounds, samples
// are heavy-tailed: those are only checked to be finite.
TEST(OddVplSets, SampledSelectionIsFiniteAndRightOnAverage) {
  constexpr std::uint32_t k_samples = 2000;
  Means means;
  for_each_odd_case([&](const OddCase& c) {
    const std::vector<Receiver> receivers = c.receivers();
    CutSelector alone(c.tree, {.size = 3}, c.bound), shared(c.tree, {.size = 4, .error = 0.2f}, c.bound);
    const TileParameters tile{.candidates = 16, .samples = 3}, least{.candidates = 1, .samples = 1};
    TileGatherer gatherer(c.scene, c.tree, tile, LobeSelection(), c.bound, 0),
        by_one(c.scene, c.tree, least, LobeSelection(), c.bound, 0);
    constexpr std::size_t k_points = 3;
    Moments by_descent, by_shared_law[k_points], by_tile[k_points], by_one_candidate;
    for (std::uint32_t sample = 0; sample < k_samples; ++sample) {
      PathContext path = context(c.scene, sample);
      const auto add = [](Moments& moments, const VplLight& light) {
        const Rgb value = light.total();
        ASSERT_TRUE(is_finite(value));
        ASSERT_GE(luminance(value), 0);
        moments.add(static_cast<double>(luminance(value)));
      };
      add(by_descent,
          gather_chosen(path, c.points[0], c.tree, alone.select({receivers.data(), 1}, path.random), c.bound));
      const auto chosen = shared.select(receivers, path.random);
      gatherer.begin_tile(receivers, path.random.get1_double(Use::tile_comb));
      by_one.begin_tile(receivers, path.random.get1_double(Use::tile_comb));
      add(by_one_candidate, by_one.gather(path, c.points[0], 1, path.random.get1_double(Use::candidate_choice)).light);
      for (std::size_t i = 0; i < k_points; ++i) {
        add(by_shared_law[i], gather_chosen(path, c.points[i], c.tree, chosen, c.bound));
        add(by_tile[i], gatherer.gather(path, c.points[i], 3, path.random.get1_double(Use::candidate_choice)).light);
      }
    }
    if (c.bound == k_infinity) return;
    means.add("descent", by_descent, c.exact(c.points[0]));
    means.add("tile, one candidate", by_one_candidate, c.exact(c.points[0]));
    for (std::size_t i = 0; i < k_points; ++i) {
      means.add("shared law", by_shared_law[i], c.exact(c.points[i]));
      means.add("tile", by_tile[i], c.exact(c.points[i]));
    }
  });
  means.expect_right();
}

TEST(OddVplSets, ATileWithoutReceiversHasNoCandidates) {
  for_each_odd_case([](const OddCase& c) {
    const TileParameters tile{.candidates = 16, .samples = 3};
    TileGatherer gatherer(c.scene, c.tree, tile, LobeSelection(), c.bound, 0);
    gatherer.begin_tile(c.receivers(), 0.5);
    gatherer.begin_tile({}, 0.5);  // forgets the tile before
    PathContext path = context(c.scene, 0);
    EXPECT_EQ(gatherer.gather(path, c.points[0], 3, 0.5).light.total(), Rgb());
  });
}

// The same through the integrators, where few light paths leave few VPLs.
TEST(OddVplSets, FewLightPathsOfEveryMethod) {
  const Scene scene = test_box({8, 8});
  const auto render = [&](const std::string& integrator, std::map<std::string, ParameterValue> parameters,
                          double light_paths) {
    parameters["vpl/light_paths"] = light_paths;
    const auto method = Method{"", integrator, std::move(parameters)}.make();
    method->prepare(scene, {.max_depth = 3});
    Film film(scene.camera().resolution(), {.gradients = method->traits().gradients, .parts = true});
    for (std::uint32_t pass = 0; pass < 2; ++pass) method->render_pass(pass, film);
    EXPECT_EQ(film.invalid_samples(), 0u) << integrator << " " << light_paths;
    return film.part(Part::vpl);
  };
  for (const double light_paths : {1.0, 2.0, 3.0, 9.0, 65.0}) {
    const RgbImage all = render("vpl", {}, light_paths);
    const RgbImage slc = render("slc", {{"cut_size", 1000.0}}, light_paths);
    const RgbImage lightcuts = render("lightcuts", {{"error_ratio", 0.0}}, light_paths);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_NEAR(luminance(slc[i]), luminance(all[i]), 2e-5f * (1 + luminance(all[i])));
      EXPECT_NEAR(luminance(lightcuts[i]), luminance(all[i]), 2e-5f * (1 + luminance(all[i])));
    }
    render("vpl", {{"selection", "power"}}, light_paths);
    render("vpl", {{"selection", "uniform"}}, light_paths);
    render("slc", {{"gather", "tile"}}, light_paths);
    render("gradslc", {}, light_paths);
    render("gradslc", {{"shift", "random_replay"}}, light_paths);
  }
}

// One random number of 64 bits serves a whole cut, rescaled from level to level: enough for a deep tree whose fluxes
// span orders of magnitude. The mean of many draws is the exact sum, to a thousandth.
TEST(CutSelector, IsUnbiasedOverADeepTree) {
  TestRandom random(3);
  VplSet set = random_vpls(random, 100000);
  for (Vpl& vpl : set.vpls) vpl.flux *= std::exp(4 * random.get1() - 2);
  const LightTree tree = builder_registry()[0].build(std::move(set));
  constexpr float k_bound = 0.3f;
  constexpr int k_receivers = 2, k_draws = 15000;
  Moments moments;  // relative to the exact sum of their receiver
  for (int k = 0; k < k_receivers; ++k) {
    const ShadedPoint x = random_gather_point(random, 1.2f);
    const Receiver receiver = make_receiver({x, LobeSelection()});
    std::vector<double> contribution;
    double exact = 0;
    for (std::size_t i = 0; i < tree.set.vpls.size(); ++i) {
      contribution.push_back(static_cast<double>(luminance(unshadowed(x, tree, i, k_bound))));
      exact += contribution.back();
    }
    CutSelector selector(tree, {.size = 100}, k_bound);
    for (std::uint32_t draw = 0; draw < k_draws; ++draw) {
      const SampleStream stream(SamplerKind::independent, 7, static_cast<std::uint64_t>(k), draw);
      double sum = 0;
      for (const ChosenVpl& chosen : selector.select({&receiver, 1}, stream))
        sum += contribution[chosen.vpl] * static_cast<double>(chosen.inverse_probability);
      moments.add(sum / exact);
    }
  }
  EXPECT_LT(moments.standard_error(), 1e-3);
  EXPECT_GT(moments.p_value(1), 0.001) << moments.mean();  // the false-alarm rate
}

}  // namespace
}  // namespace gradslc
