// The two levels of gathering by tiles: the comb's draw of candidates, and a pixel's choice among them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lighttree/candidates.h"
#include "random_vpls.h"

namespace gradslc {
namespace {

LightTree pairs(VplSet set) { return builder_registry()[0].build(std::move(set)); }

constexpr int k_places = 512;  // of a comb: an even grid, so that means over it are integrals

struct Tile {
  std::vector<ShadedPoint> points;
  std::vector<Receiver> receivers;
};

Tile random_tile(TestRandom& random, std::size_t count, bool glossy) {
  Tile tile;
  for (std::size_t i = 0; i < count; ++i) {
    tile.points.push_back(random_gather_point(random, 1.5f, glossy));
    tile.receivers.push_back(make_receiver({tile.points.back(), LobeSelection()}));
  }
  return tile;
}

TEST(Comb, CountsAreWhatTheProbabilitiesSayAndNoVplThatLightsAReceiverIsMissed) {
  TestRandom random(1);
  for (int round = 0; round < 20; ++round) {
    const bool glossy = round % 2 == 0;
    const LightTree tree = pairs(random_vpls(random, 1 + random.below(200), 1, glossy));
    const Tile tile = random_tile(random, 1 + random.below(40), glossy);
    const float bound = round % 3 == 0 ? k_infinity : 0.7f;
    const float power_share = static_cast<float>(round % 4) / 3;
    const TileLaw law(tile.receivers, {.power_share = power_share, .bound = bound});
    const int size = 1 + static_cast<int>(random.below(64));
    std::vector<double> mean_count(tree.set.vpls.size(), 0), probability(tree.set.vpls.size(), 0);
    std::vector<Candidate> candidates;
    for (int i = 0; i < k_places; ++i) {
      draw_candidates(tree, law, size, (i + 0.5) / k_places, candidates);
      for (const Candidate& c : candidates) {
        mean_count[c.vpl] += static_cast<double>(c.count) / k_places;
        probability[c.vpl] = c.probability;
      }
    }
    double sum = 0;
    for (std::size_t i = 0; i < mean_count.size(); ++i) {
      // A comb's count differs from its mean by less than one; on the grid of places the mean by one place.
      EXPECT_NEAR(mean_count[i], size * probability[i], 1.01 / k_places);
      sum += probability[i];
    }
    EXPECT_LE(sum, 1 + 1e-9);
    for (std::size_t i = 0; i < mean_count.size(); ++i)
      for (const ShadedPoint& x : tile.points)
        if (max_channel(unshadowed(x, tree, i, bound)) > 1e-3f && probability[i] == 0) {
          // Only a probability below the grid's resolution may go unseen.
          EXPECT_LT(sum, 1) << "VPL " << i;
        }
  }
}

TEST(Comb, MixesTheLawWithPower) {
  TestRandom random(9);
  for (int round = 0; round < 50; ++round) {
    const LightTree tree = pairs(random_vpls(random, 2 + random.below(7), 1, round % 2 == 0));  // one node
    const Tile tile = random_tile(random, 40, round % 2 == 0);
    alignas(32) LightNode::Lanes weights;
    TileLaw(tile.receivers, {.bound = 1}).weigh(tree, 0, weights);
    double weight_sum = 0, power_sum = 0;
    for (int lane = 0; lane < LightNode::k_width; ++lane)
      if (weights[lane] > 0)
        weight_sum += static_cast<double>(weights[lane]),
            power_sum += static_cast<double>(tree.nodes[0].capped_flux[lane]);
    for (const float power_share : {0.0f, 0.25f, 1.0f}) {
      std::vector<Candidate> candidates;
      const TileLaw law(tile.receivers, {.power_share = power_share, .bound = 1});
      draw_candidates(tree, law, 1 << 16, 0.5, candidates);
      std::size_t alive = 0;
      for (int lane = 0; lane < LightNode::k_width; ++lane) {
        if (weights[lane] == 0) continue;
        const double by_law = static_cast<double>(weights[lane]) / weight_sum;
        const double by_power = static_cast<double>(tree.nodes[0].capped_flux[lane]) / power_sum;
        const double expected =
            (1 - static_cast<double>(power_share)) * by_law + static_cast<double>(power_share) * by_power;
        const auto drawn = std::find_if(candidates.begin(), candidates.end(),
                                        [&](const Candidate& c) { return c.vpl == tree.nodes[0].vpl(lane); });
        if (expected * (1 << 16) < 1) continue;  // may have been missed
        ASSERT_NE(drawn, candidates.end());
        EXPECT_NEAR(drawn->probability, expected, 1e-9);
        EXPECT_NEAR(drawn->count, expected * (1 << 16), 1.0);
        ++alive;
      }
      EXPECT_GT(alive, 0u);
    }
  }
}

TEST(Comb, LawIsPositiveWhereverAVplLightsAReceiver) {
  TestRandom random(2);
  std::size_t lit = 0;
  for (int round = 0; round < 200; ++round) {
    const bool glossy = round % 2 == 0;
    const LightTree tree = pairs(random_vpls(random, 1 + random.below(8), 1, glossy));
    const Tile tile = random_tile(random, 1 + random.below(60), glossy);
    const TileLaw law(tile.receivers, {.bound = 0.7f});
    alignas(32) LightNode::Lanes weights;
    law.weigh(tree, 0, weights);
    for (int lane = 0; lane < LightNode::k_width; ++lane) {
      if (!tree.nodes[0].has_child(lane)) {
        EXPECT_EQ(weights[lane], 0);
        continue;
      }
      ASSERT_TRUE(std::isfinite(weights[lane]));
      for (const ShadedPoint& x : tile.points)
        if (!is_black(unshadowed(x, tree, tree.nodes[0].vpl(lane), 0.7f))) {
          ++lit;
          ASSERT_GT(weights[lane], 0);
        }
    }
  }
  EXPECT_GT(lit, 1000u);
}

TEST(Comb, LawIsPositiveWhereverAVplLightsAPointWithinReach) {
  TestRandom random(7);
  constexpr float k_reach = 0.8f;
  std::size_t lit = 0, lit_there_only = 0;
  for (int round = 0; round < 2000; ++round) {
    const bool glossy = round % 2 == 0;
    const LightTree tree = pairs(random_vpls(random, 1 + random.below(8), 1, glossy));
    const Tile tile = random_tile(random, 1 + random.below(3), false);
    const float floor = round % 5 == 0 ? 0 : 0.2f;
    const TileLaw law(tile.receivers, {.cosine_floor = floor, .bound = 0.7f, .reach = k_reach});
    const TileLaw law_without(tile.receivers, {.defensive = 0.1f, .cosine_floor = 0.2f, .bound = 0.7f});
    alignas(32) LightNode::Lanes weights, weights_without;
    law.weigh(tree, 0, weights), law_without.weigh(tree, 0, weights_without);
    ShadedPoint y = random_gather_point(random, 1, glossy);
    const Vec3 step = y.wo;  // any direction
    y.point.position = tile.points[0].point.position + 0.999f * k_reach * random.get1() * step;
    for (int lane = 0; lane < LightNode::k_width; ++lane) {
      if (!tree.nodes[0].has_child(lane)) continue;
      if (is_black(unshadowed(y, tree, tree.nodes[0].vpl(lane), 0.7f))) continue;
      ++lit;
      lit_there_only += weights_without[lane] == 0;
      ASSERT_GT(weights[lane], 0);
    }
  }
  EXPECT_GT(lit, 1000u);
  EXPECT_GT(lit_there_only, 100u);
}

TEST(Comb, WeightsDoNotDependOnTheUnitOfLength) {
  TestRandom random(3);
  constexpr float k_scale = 1024;
  const VplSet set = random_vpls(random, 8, 1, true);
  VplSet large = set;
  for (Vpl& vpl : large.vpls) vpl.position = Point3() + k_scale * from_origin(vpl.position);
  Tile tile = random_tile(random, 30, true);
  const TileLaw law(tile.receivers, {.bound = 2, .reach = 0.3f});
  for (Receiver& r : tile.receivers) r.position = Point3() + k_scale * from_origin(r.position);
  const TileLaw large_law(tile.receivers, {.bound = 2 / (k_scale * k_scale), .reach = 0.3f * k_scale});
  alignas(32) LightNode::Lanes a, b;
  law.weigh(pairs(set), 0, a);
  large_law.weigh(pairs(large), 0, b);
  for (int lane = 0; lane < LightNode::k_width; ++lane)
    EXPECT_NEAR(b[lane] * k_scale * k_scale, a[lane], 1e-4f * a[lane]);
}

/// All VPLs of a set as candidates, with random counts and probabilities.
std::vector<Candidate> every_vpl(TestRandom& random, const VplSet& set) {
  std::vector<Candidate> candidates;
  candidates.reserve(set.vpls.size());
  for (std::uint32_t i = 0; i < set.vpls.size(); ++i)
    candidates.push_back({i, 1 + static_cast<std::uint32_t>(random.below(3)), 0.01 + 0.5 * random.get1_double()});
  return candidates;
}

TEST(Candidates, TargetsAreTheContributionsWhereBothLobesAreLambert) {
  TestRandom random(4);
  CandidateSet candidates;
  for (int round = 0; round < 300; ++round) {
    const LightTree tree = pairs(random_vpls(random, 1 + random.below(60)));
    const ShadedPoint x = random_gather_point(random, 1.2f);
    const float bound = round % 3 == 0 ? k_infinity : std::exp(6 * random.get1() - 3);
    candidates.assign(tree.set, every_vpl(random, tree.set), 10);
    const CandidateReceiver receiver = make_candidate_receiver({x, LobeSelection()}, 1, 5);
    ASSERT_TRUE(receiver.lambert);
    candidates.evaluate(receiver, bound);
    float largest = 0;
    for (std::uint32_t i = 0; i < candidates.size(); ++i) largest = std::max(largest, candidates.target(i));
    for (std::uint32_t i = 0; i < candidates.size(); ++i) {
      const Rgb exact = candidates.weight(i) * unshadowed(x, tree, candidates.vpl(i), bound);
      const Rgb found = candidates.contribution(receiver, i);
      for (const auto& [a, b] : {std::pair{exact.r, found.r}, {exact.g, found.g}, {exact.b, found.b}})
        ASSERT_NEAR(a, b, 2e-4f * a + 1e-9f);
      ASSERT_NEAR(candidates.target(i), k_pi * k_pi * max_channel(exact),
                  2e-4f * k_pi * k_pi * max_channel(exact) + 2e-5f * largest);
    }
  }
}

TEST(Candidates, TargetsArePositiveWhereverThereIsAContribution) {
  TestRandom random(5);
  CandidateSet candidates;
  std::size_t lit = 0;
  for (int round = 0; round < 2000; ++round) {
    VplSet one = random_vpls(random, 1, 1, true);
    one.vpls[0].vertex = static_cast<std::uint16_t>(1 + random.below(3));
    const ShadedPoint x = random_gather_point(random, 1.2f, true);
    const float bound = round % 3 == 0 ? k_infinity : 1.0f;
    candidates.assign(one, every_vpl(random, one), 10);
    const CandidateReceiver receiver = make_candidate_receiver({x, LobeSelection()}, 1, 2);
    candidates.evaluate(receiver, bound);
    const Rgb exact = unshadowed_contribution({x, LobeSelection()}, {materials(), one}, one.vpls[0], bound);
    ASSERT_TRUE(std::isfinite(candidates.target(0)));
    if (one.vpls[0].vertex > 2) {
      ASSERT_EQ(candidates.target(0), 0);
    } else if (!is_black(exact)) {
      ++lit;
      ASSERT_GT(candidates.target(0), 0);
    }
  }
  EXPECT_GT(lit, 200u);
}

// Towards the points that they were calibrated with, glossy candidates are taken for what their lobes are, but for the
// share of the bound that is left to other directions; everywhere else they stay possible and below the bound.
TEST(Candidates, GlossyOnesAreCalibratedByTheirValues) {
  TestRandom random(8);
  CandidateSet bounded, calibrated;
  std::size_t compared = 0;
  for (int round = 0; round < 2000; ++round) {
    const VplSet one = random_vpls(random, 1, 1, true);
    const VplView view{materials(), one};
    const ShadedPoint x = random_gather_point(random, 1.2f), elsewhere = random_gather_point(random, 1.2f);
    const auto candidates = every_vpl(random, one);
    bounded.assign(one, candidates, 10), calibrated.assign(one, candidates, 10);
    const Point3 towards[] = {x.point.position};
    calibrated.calibrate(view, LobeSelection(), towards);
    const auto targets = [&](const ShadedPoint& at) {
      const CandidateReceiver receiver = make_candidate_receiver({at, LobeSelection()}, 1, 5);
      bounded.evaluate(receiver, k_infinity), calibrated.evaluate(receiver, k_infinity);
      return std::pair{bounded.target(0), calibrated.target(0)};
    };
    const auto [bound_elsewhere, target_elsewhere] = targets(elsewhere);
    EXPECT_EQ(target_elsewhere > 0, bound_elsewhere > 0);
    EXPECT_LE(target_elsewhere, bound_elsewhere * 1.0001f);
    const auto [bound, target] = targets(x);
    const Vpl& vpl = one.vpls[0];
    if (vpl.is_lambert()) {
      EXPECT_EQ(target, bound);
      continue;
    }
    if (!(bound > 0)) continue;
    const Vec3 d = x.point.position - vpl.position;
    const float pi_f = max_channel(GlossyVpl(view, vpl).pi_f(normalize(d), LobeSelection()));
    const float per_pi_f = target / std::max(pi_f, 1e-20f), least = 0.02f * bound;
    if (target > 1.01f * least) {
      // f_c(x) |cos_x cos_y| / d^2 flux, by the same VPL as if it were Lambert with pi f = 1.
      const Rgb albedo = *x.bsdf.lambert_albedo(x.wo, LobeSelection());
      const float geometry =
          std::abs(dot(d, vpl.geometric_normal.decode()) * dot(d, x.frame.n)) / (length_squared(d) * length_squared(d));
      EXPECT_NEAR(per_pi_f / (max_channel(albedo * vpl.flux) * geometry * calibrated.weight(0)), 1, 2e-3f);
      ++compared;
    } else {
      EXPECT_NEAR(target, least, 2e-3f * least);
    }
  }
  EXPECT_GT(compared, 100u);
}

// Over the random subsets a draw's light has the mean that all candidates have: the sum of their targets.
TEST(Candidates, SubsetsStandForTheWholeSet) {
  TestRandom random(9);
  CandidateSet candidates;
  std::vector<CandidateDraw> draws;
  for (int round = 0; round < 60; ++round) {
    const LightTree tree = pairs(random_vpls(random, 1 + random.below(100), 1, round % 2 == 0));
    const ShadedPoint x = random_gather_point(random, 1.2f, round % 2 == 0);
    candidates.assign(tree.set, every_vpl(random, tree.set), 10);
    const CandidateReceiver receiver = make_candidate_receiver({x, LobeSelection()}, 1, 5);
    candidates.evaluate(receiver, 1);
    double total = 0;
    std::vector<double> targets;
    for (std::uint32_t i = 0; i < candidates.size(); ++i) {
      targets.push_back(static_cast<double>(candidates.target(i)));
      total += targets.back();
    }
    // A place u of the comb and a subset are each as likely as any other.
    constexpr int k_subsets = 60;  // a multiple of any number of them
    double mean = 0;
    for (int s = 0; s < k_subsets; ++s) {
      candidates.evaluate(receiver, 1, candidates.random_subset((static_cast<float>(s) + 0.5f) / k_subsets));
      for (int i = 0; i < 50; ++i) {
        candidates.choose(1, (i + 0.5) / 50, draws);
        for (const CandidateDraw& draw : draws) mean += targets[draw.candidate] / draw.probability / (50 * k_subsets);
      }
    }
    EXPECT_NEAR(mean, total, 1e-3 * total) << round;
  }
}

TEST(Candidates, DrawsAreWhatTheProbabilitiesSay) {
  TestRandom random(6);
  CandidateSet candidates;
  std::vector<CandidateDraw> draws;
  for (int round = 0; round < 30; ++round) {
    const LightTree tree = pairs(random_vpls(random, 1 + random.below(100), 1, round % 2 == 0));
    const ShadedPoint x = random_gather_point(random, 1.2f, round % 2 == 0);
    candidates.assign(tree.set, every_vpl(random, tree.set), 10);
    candidates.evaluate(make_candidate_receiver({x, LobeSelection()}, 1, 5), 1);
    double total = 0;
    for (std::uint32_t i = 0; i < candidates.size(); ++i) total += static_cast<double>(candidates.target(i));
    const int samples = 1 + static_cast<int>(random.below(20));
    std::vector<double> mean_count(candidates.size(), 0);
    for (int i = 0; i < k_places; ++i) {
      candidates.choose(samples, (i + 0.5) / k_places, draws);
      std::uint32_t drawn = 0;
      for (const CandidateDraw& draw : draws) {
        drawn += draw.count;
        mean_count[draw.candidate] += static_cast<double>(draw.count) / k_places;
        EXPECT_NEAR(draw.probability, static_cast<double>(candidates.target(draw.candidate)) / total, 1e-5);
      }
      EXPECT_EQ(drawn, total > 0 ? static_cast<std::uint32_t>(samples) : 0u);
    }
    if (total == 0) continue;
    for (std::uint32_t i = 0; i < candidates.size(); ++i)
      EXPECT_NEAR(mean_count[i], samples * static_cast<double>(candidates.target(i)) / total, 1.01 / k_places + 1e-4);
  }
}

TEST(Candidates, TargetsHeedWhatIsKnownOfVisibility) {
  TestRandom random(8);
  CandidateSet candidates;
  for (const bool glossy : {false, true}) {  // both kernels
    const LightTree tree = pairs(random_vpls(random, 200, 1, glossy));
    const ShadedPoint x = random_gather_point(random, 1.2f, glossy);
    const CandidateReceiver receiver = make_candidate_receiver({x, LobeSelection()}, 1, 5);
    const auto targets = [&] {
      candidates.evaluate(receiver, 1);
      std::vector<float> found;
      found.reserve(candidates.size());
      for (std::uint32_t i = 0; i < candidates.size(); ++i) found.push_back(candidates.target(i));
      return found;
    };
    const std::vector<Candidate> all = every_vpl(random, tree.set);
    candidates.assign(tree.set, all, 10);
    const std::vector<float> before = targets();
    const float tolerance = 1e-4f * *std::max_element(before.begin(), before.end());

    std::vector<float> tests(before.size(), 0), hits(before.size(), 0);
    for (std::uint32_t i = 0; i < before.size(); i += 1 + static_cast<std::uint32_t>(random.below(3)))
      for (int n = static_cast<int>(random.below(40)); n > 0; --n) {
        const bool visible = random.get1() < (i % 3 == 0 ? 0.0f : i % 3 == 1 ? 0.3f : 1.0f);
        candidates.note_visibility(i, visible);
        tests[i] += 1, hits[i] += visible ? 1.0f : 0.0f;
      }
    EXPECT_EQ(targets(), before) << "noting alone changes nothing";
    candidates.learn_visibility();
    const std::vector<float> after = targets();

    const int lanes = static_cast<int>(FloatV::size()), count = static_cast<int>(before.size());
    const int in_a_lane = (count + lanes - 1) / lanes;  // neighbours are those of the same lane
    for (int i = 0; i < count; ++i) {
      const int first = i / in_a_lane * in_a_lane, last = std::min(first + in_a_lane, count) - 1;
      float nearby_tests = 0, nearby_hits = 0;
      for (int j = std::max(i - 4, first); j <= std::min(i + 4, last); ++j)
        nearby_tests += tests[static_cast<std::size_t>(j)], nearby_hits += hits[static_cast<std::size_t>(j)];
      const auto own = static_cast<std::size_t>(i);
      const float seen = (hits[own] + 2 * (nearby_hits + 1) / (nearby_tests + 2)) / (tests[own] + 2);
      EXPECT_NEAR(after[own], before[own] * std::sqrt(std::max(seen, 0.04f)), 1e-4f * before[own] + tolerance);
      EXPECT_EQ(after[own] > 0, before[own] > 0) << "what was never seen stays possible";
    }
    candidates.assign(tree.set, all, 10);
    EXPECT_EQ(targets(), before) << "another tile begins anew";
  }
}

TEST(Candidates, DegenerateSets) {
  TestRandom random(7);
  CandidateSet candidates;
  std::vector<CandidateDraw> draws;
  const ShadedPoint x = random_gather_point(random, 1);
  candidates.assign({}, {}, 10);
  candidates.evaluate(make_candidate_receiver({x, LobeSelection()}, 1, 5), 1);
  candidates.choose(5, 0.5, draws);
  EXPECT_TRUE(draws.empty());

  VplSet same = random_vpls(random, 1);
  same.vpls[0].position = x.point.position;  // in the receiver's place: contributes nothing, and is no NaN
  same.vpls.assign(17, same.vpls[0]);
  candidates.assign(same, every_vpl(random, same), 10);
  candidates.evaluate(make_candidate_receiver({x, LobeSelection()}, 1, 5), k_infinity);
  candidates.choose(5, 0.5, draws);
  EXPECT_TRUE(draws.empty());
  std::vector<Candidate> drawn;
  const Receiver receiver = make_receiver({x, LobeSelection()});
  EXPECT_EQ(draw_candidates({}, TileLaw({&receiver, 1}, {}), 8, 0.5, drawn), 0u);
  EXPECT_TRUE(drawn.empty());
}

}  // namespace
}  // namespace gradslc
