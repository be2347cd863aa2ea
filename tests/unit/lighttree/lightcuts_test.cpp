// Representatives of clusters, and the cuts that lightcuts estimates with them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "lighttree/estimated_cut.h"
#include "random_vpls.h"
#include "support/statistics.h"
#include "tree_walk.h"

namespace gradslc {
namespace {

LightTree pairs(VplSet set) { return builder_registry()[0].build(std::move(set)); }

double flux_of(const LightTree& tree, std::uint32_t vpl) {
  return static_cast<double>(luminance(tree.set.vpls[vpl].flux));
}

TEST(Representatives, AreDrawnInProportionToFlux) {
  TestRandom random(1);
  const LightTree tree = pairs(random_vpls(random, 20));
  constexpr int k_trees = 20000;
  constexpr LaneMask k_masks[] = {0b1, 0b110, 0b111};
  std::vector<std::vector<double>> observed(std::size(k_masks), std::vector<double>(20, 0));
  for (std::uint64_t seed = 0; seed < k_trees; ++seed) {
    const Representatives representatives(tree, seed);
    for (std::size_t m = 0; m < std::size(k_masks); ++m) ++observed[m][representatives.of(0, k_masks[m]).vpl];
  }
  for (std::size_t m = 0; m < std::size(k_masks); ++m) {
    const std::vector<std::uint32_t> below = vpls_below(tree, 0, k_masks[m]);
    double total = 0;
    for (const std::uint32_t i : below) total += flux_of(tree, i);
    std::vector<double> expected(20, 0);
    for (const std::uint32_t i : below) expected[i] = k_trees * flux_of(tree, i) / total;
    // False-alarm rate 0.1 %.
    EXPECT_GT(chi_square_test(observed[m], expected).p_value, sidak(0.001, std::size(k_masks)));
  }
}

TEST(Representatives, LieInTheirClusterStandForItsFluxAndStayWithOnePart) {
  TestRandom random(2);
  for (const std::size_t count : {1u, 2u, 3u, 9u, 300u}) {
    const LightTree tree = pairs(random_vpls(random, count, 1, true));
    const Representatives representatives(tree, count);
    std::vector<Receiver> receivers;  // enough that no cluster is without light for all of them
    for (int k = 0; k < 30; ++k)
      receivers.push_back(make_receiver({random_gather_point(random, 1, true), LobeSelection()}));
    std::vector<ChildWeights> evaluated;
    ClusterSplitter splitter(tree, receivers, 1, evaluated);
    std::vector<CutEntry> stack;
    for (const CutEntry& entry : splitter.root()) stack.push_back(entry);
    std::size_t splits = 0;
    while (!stack.empty()) {
      const CutEntry entry = stack.back();
      stack.pop_back();
      const auto whole = representatives.of(entry.node, entry.lanes);
      const std::vector<std::uint32_t> below = vpls_below(tree, entry.node, entry.lanes);
      EXPECT_EQ(std::count(below.begin(), below.end(), whole.vpl), 1);
      double flux = 0;
      for (const std::uint32_t i : below) flux += flux_of(tree, i);
      EXPECT_NEAR(static_cast<double>(whole.flux), flux, 1e-5 * flux);
      if (is_single_vpl(tree, entry)) continue;
      const CutParts parts = splitter.split(entry);
      bool holder_is_dark = true;  // parts that light no receiver are left out
      std::size_t keep = 0;
      for (const CutEntry& part : parts) {
        const std::vector<std::uint32_t> part_below = vpls_below(tree, part.node, part.lanes);
        if (std::count(part_below.begin(), part_below.end(), whole.vpl) == 1) holder_is_dark = false;
        keep += representatives.of(part.node, part.lanes).vpl == whole.vpl ? 1 : 0;
        stack.push_back(part);
      }
      EXPECT_EQ(keep, holder_is_dark ? 0u : 1u);
      ++splits;
    }
    EXPECT_GE(splits, (count - 1) / 2);
  }
}

TEST(Representatives, AreTheSameForAnyNumberOfThreads) {
  TestRandom random(3);
  const LightTree tree = pairs(random_vpls(random, 50000));
  const int threads_before = thread_count();
  set_thread_count(1);
  const Representatives one(tree, 5);
  set_thread_count(7);
  const Representatives seven(tree, 5);
  set_thread_count(threads_before);
  for (NodeIndex node = 0; node < tree.nodes.size(); ++node) {
    const auto a = one.of(node, k_all_lanes), b = seven.of(node, k_all_lanes);
    EXPECT_EQ(a.vpl, b.vpl);
    EXPECT_EQ(a.flux, b.flux);
  }
}

/// Light of all kinds of VPLs at random points, every third VPL in shadow.
class EstimatedCuts : public testing::Test {
 protected:
  struct Case {
    LightTree tree;
    ShadedPoint x;
    Receiver receiver;
    float bound;

    Rgb contribution(std::uint32_t vpl) const { return vpl % 3 == 0 ? Rgb() : unshadowed(x, tree, vpl, bound); }
    double exact(std::span<const std::uint32_t> vpls) const {
      double sum = 0;
      for (const std::uint32_t i : vpls) sum += static_cast<double>(luminance(contribution(i)));
      return sum;
    }
  };
  static Case random_case(TestRandom& random, std::size_t count, bool glossy, float bound) {
    Case c{pairs(random_vpls(random, count, 1, glossy)), random_gather_point(random, 1, glossy), {}, bound};
    c.receiver = make_receiver({c.x, LobeSelection()});
    return c;
  }
  static EstimatedCut find(const Case& c, std::uint64_t seed, const ErrorLimits& limits) {
    EstimatedCut cut;
    find_estimated_cut(
        c.tree, Representatives(c.tree, seed), c.receiver, c.bound, limits,
        [&](std::uint32_t vpl) { return c.contribution(vpl); }, cut);
    return cut;
  }
  static std::vector<std::uint32_t> below(const Case& c, const EstimatedCluster& cluster) {
    return vpls_below(c.tree, cluster.entry.node, cluster.entry.lanes);
  }
};

TEST_F(EstimatedCuts, ClustersBringNoMoreThanTheirErrorAndVplsAreExact) {
  TestRandom random(4);
  for (int round = 0; round < 600; ++round) {
    const float bound = round % 3 == 0 ? k_infinity : std::exp(4 * random.get1() - 2);
    const Case c = random_case(random, 1 + random.below(200), round % 2 == 0, bound);
    const EstimatedCut cut = find(c, random.bits(), {0.02f, 1 + static_cast<int>(random.below(60))});
    for (const EstimatedCluster& cluster : cut.clusters) {
      const double exact = c.exact(below(c, cluster));
      if (is_single_vpl(c.tree, cluster.entry)) {
        EXPECT_EQ(cluster.error, 0);
        EXPECT_NEAR(static_cast<double>(luminance(cluster.estimate)), exact, 1e-5 * exact);
      } else {
        EXPECT_LE(exact, static_cast<double>(cluster.error) * (1 + 1e-5));
      }
    }
  }
}

TEST_F(EstimatedCuts, StopWhereTheLargestErrorIsWithinTheRatioOrTheCutIsFull) {
  TestRandom random(5);
  int within = 0, full = 0;
  for (int round = 0; round < 300; ++round) {
    const Case c = random_case(random, 400, false, 1);
    const ErrorLimits limits{round % 2 == 0 ? 0.05f : 0.2f, round % 3 == 0 ? 20 : 300};
    const EstimatedCut cut = find(c, random.bits(), limits);
    ASSERT_LE(cut.clusters.size(), static_cast<std::size_t>(limits.most_clusters));
    if (cut.clusters.empty()) continue;
    double largest = 0;
    for (const EstimatedCluster& cluster : cut.clusters)
      largest = std::max(largest, static_cast<double>(cluster.error));
    const double allowed = static_cast<double>(limits.error_ratio * luminance(cut.total()));
    if (cut.clusters.size() == static_cast<std::size_t>(limits.most_clusters)) {
      ++full;
    } else {
      ++within;
      EXPECT_LE(largest, allowed * (1 + 1e-4));
    }
  }
  EXPECT_GT(within, 20);
  EXPECT_GT(full, 20);
}

// What is known of a representative is handed down: no VPL is asked twice, nor is a second shadow ray traced to it.
TEST_F(EstimatedCuts, AskEveryVplOnceAtMost) {
  TestRandom random(8);
  for (int round = 0; round < 50; ++round) {
    const Case c = random_case(random, 300, round % 2 == 0, 1);
    std::vector<int> asked(300, 0);
    EstimatedCut cut;
    find_estimated_cut(
        c.tree, Representatives(c.tree, random.bits()), c.receiver, c.bound, {0, 200},
        [&](std::uint32_t vpl) {
          ++asked[vpl];
          return c.contribution(vpl);
        },
        cut);
    EXPECT_LE(*std::max_element(asked.begin(), asked.end()), 1);
    EXPECT_EQ(std::count(asked.begin(), asked.end(), 1), static_cast<std::ptrdiff_t>(cut.representatives));
  }
}

TEST_F(EstimatedCuts, FullCutsAreExactAndSmallOnesCountEveryVplOnce) {
  TestRandom random(6);
  for (int round = 0; round < 100; ++round) {
    const Case c = random_case(random, 1 + random.below(100), round % 2 == 0, round % 3 == 0 ? k_infinity : 1.0f);
    const std::vector<std::uint32_t> all = vpls_below(c.tree, 0);
    const EstimatedCut exact = find(c, 1, {0, 1000});
    EXPECT_NEAR(static_cast<double>(luminance(exact.total())), c.exact(all), 1e-5 * c.exact(all));
    std::vector<int> covered(all.size(), 0);
    for (const EstimatedCluster& cluster : find(c, 1, {0.1f, 10}).clusters)
      for (const std::uint32_t i : below(c, cluster)) ++covered[i];
    for (std::size_t i = 0; i < covered.size(); ++i) {
      EXPECT_LE(covered[i], 1);
      if (!is_black(unshadowed(c.x, c.tree, i, c.bound))) {
        EXPECT_EQ(covered[i], 1);
      }
    }
  }
}

// Chosen in proportion to flux and scaled by the cluster's flux over its own, a representative is right on average.
TEST_F(EstimatedCuts, OneClusterIsExactOnAverageOverRepresentatives) {
  TestRandom random(7);
  constexpr std::size_t k_cases = 6;
  for (std::size_t i = 0; i < k_cases; ++i) {
    const Case c = random_case(random, 40, i % 2 == 0, 1);
    const std::vector<std::uint32_t> all = vpls_below(c.tree, 0);
    if (c.exact(all) == 0) continue;
    Moments moments;
    for (std::uint64_t seed = 0; seed < 4000; ++seed)
      moments.add(static_cast<double>(luminance(find(c, seed, {0, 1}).total())));
    // False-alarm rate 0.1 %.
    EXPECT_GT(moments.p_value(c.exact(all)), sidak(0.001, k_cases)) << moments.mean() << " " << c.exact(all);
  }
}

}  // namespace
}  // namespace gradslc
