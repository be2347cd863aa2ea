#include "lighttree/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "lighttree/bounds.h"
#include "lighttree/cut.h"
#include "lighttree/descent.h"
#include "lighttree/fill_node.h"
#include "random_vpls.h"
#include "support/statistics.h"
#include "tree_walk.h"

namespace gradslc {
namespace {

// The SIMD twin of make_cluster(), to the bit.
TEST(FillNode, LeavesAreTheirVplsClusters) {
  TestRandom random(11);
  for (int round = 0; round < 1000; ++round) {
    LightTree tree;
    tree.set = random_vpls(random, 1 + random.below(8), 1, round % 2 == 0);
    const auto count = static_cast<int>(tree.set.vpls.size());
    resize_nodes(tree, 1);
    fill_leaf_node(tree, 0, 0, count);
    ASSERT_EQ(tree.nodes[0].child_count(), count);
    for (int lane = 0; lane < count; ++lane) {
      const LightCluster scalar = make_cluster(tree.set, tree.set.vpls[static_cast<std::size_t>(lane)]);
      const LightCluster filled = cluster_of_lane(tree, 0, lane);
      EXPECT_EQ(filled.box.lower, scalar.box.lower);
      EXPECT_EQ(filled.box.upper, scalar.box.upper);
      EXPECT_EQ(filled.flux, scalar.flux);
      EXPECT_EQ(filled.capped_flux, scalar.capped_flux);
      EXPECT_EQ(filled.normals.axis, scalar.normals.axis);
      EXPECT_EQ(filled.normals.cosine, scalar.normals.cosine);
      EXPECT_EQ(filled.gloss.peak, scalar.gloss.peak);
    }
  }
}

class Builders : public testing::TestWithParam<const char*> {
 protected:
  static LightTree build(VplSet set) {
    for (const BuilderEntry& entry : builder_registry())
      if (std::string(entry.name) == GetParam()) return entry.build(std::move(set));
    return {};
  }
};
INSTANTIATE_TEST_SUITE_P(All, Builders, testing::ValuesIn([] {
                           std::vector<const char*> names;
                           for (const BuilderEntry& entry : builder_registry()) names.push_back(entry.name);
                           return names;
                         }()),
                         [](const auto& entry) { return std::string(entry.param); });

TEST_P(Builders, HoldEveryVplOnceAndBoundIt) {
  TestRandom random(2);
  for (const std::size_t count : {1u, 2u, 3u, 5u, 64u, 65u, 1000u}) {
    const VplSet set = random_vpls(random, count);
    const LightTree tree = build(set);
    ASSERT_EQ(tree.set.vpls.size(), count);
    std::vector<std::uint32_t> all = vpls_below(tree, 0);
    std::sort(all.begin(), all.end());
    std::vector<std::uint32_t> expected(count);
    std::iota(expected.begin(), expected.end(), 0u);
    EXPECT_EQ(all, expected);
    double flux_in = 0, flux_out = 0;
    for (const Vpl& vpl : set.vpls) flux_in += static_cast<double>(luminance(vpl.flux));
    for (const Vpl& vpl : tree.set.vpls) flux_out += static_cast<double>(luminance(vpl.flux));
    EXPECT_NEAR(flux_in, flux_out, 1e-6 * flux_in);
    for_each_child(tree, 0, k_all_lanes, [&](Child child) {
      const LightCluster cluster = cluster_of_lane(tree, child.node, child.lane);
      double flux = 0;
      for (const std::uint32_t i : vpls_below(tree, child)) {
        EXPECT_TRUE(cluster.box.contains(tree.set.vpls[i].position));
        EXPECT_GE(dot(cluster.normals.axis, tree.set.vpls[i].geometric_normal.decode()),
                  cluster.normals.cosine - 1e-6f);
        flux += static_cast<double>(luminance(tree.set.vpls[i].flux));
      }
      EXPECT_NEAR(flux, static_cast<double>(cluster.flux), 1e-5 * flux);
    });
  }
}

TEST_P(Builders, DegenerateInputs) {
  EXPECT_TRUE(build({}).empty());
  TestRandom random(3);
  VplSet same = random_vpls(random, 1);
  same.vpls.assign(17, same.vpls[0]);
  EXPECT_EQ(vpls_below(build(same), 0).size(), 17u);
  for (Vpl& vpl : same.vpls) vpl.flux = Rgb();
  const LightTree black = build(same);
  const ShadedPoint x = random_gather_point(random, 1);
  const Receiver r = make_receiver({x, LobeSelection()});
  EXPECT_EQ(cluster_bound(cluster_of_lane(black, 0, 0), r, 1), 0);
  LightCut cut;
  find_cut(black, {&r, 1}, 1, {.size = 10}, cut);
  EXPECT_TRUE(cut.entries.empty());
}

std::size_t depth_of(const LightTree& tree) {
  std::vector<std::size_t> depth(tree.nodes.size(), 1);
  std::size_t deepest = 1;
  for_each_child(tree, 0, k_all_lanes, [&](Child child) {  // parents come before their children
    const LightNode& node = tree.nodes[child.node];
    if (node.is_leaf(child.lane)) return;
    depth[node.child[child.lane]] = depth[child.node] + 1;
    deepest = std::max(deepest, depth[child.node] + 1);
  });
  return deepest;
}

TEST_P(Builders, DepthAndMemoryAreBoundedWhateverThePositions) {
  TestRandom random(9);
  constexpr std::size_t k_count = 4097;
  const VplSet scattered = random_vpls(random, k_count);
  VplSet point = scattered, line = scattered, plane = scattered, converging = scattered, duplicates = scattered;
  for (std::size_t i = 0; i < k_count; ++i) {
    point.vpls[i].position = {1, 2, 3};
    line.vpls[i].position = {static_cast<float>(i), 0, 0};
    plane.vpls[i].position.z = 0;
    const float nearer = std::ldexp(1.0f, -static_cast<int>(i % 120));
    converging.vpls[i].position = {nearer, -nearer, nearer};
    duplicates.vpls[i].position = duplicates.vpls[i % 7].position;
  }
  for (const VplSet& set : {scattered, point, line, plane, converging, duplicates}) {
    const LightTree tree = build(set);
    EXPECT_EQ(vpls_below(tree, 0).size(), k_count);
    EXPECT_LE(depth_of(tree), 10u);  // 5 where all nodes are full
    EXPECT_LE(tree.nodes.size(), k_count / 5);
  }
}

TEST_P(Builders, TakesTheMemoryThatIsPlanned) {
  TestRandom random(10);
  constexpr std::size_t k_count = 100000;
  VplSet set = random_vpls(random, k_count);
  for (Vpl& vpl : set.vpls) vpl.position.z = 0;
  for (const BuilderEntry& entry : builder_registry()) {
    if (std::string(entry.name) != GetParam()) continue;
    const VplCounts counts{static_cast<double>(k_count), 0};
    const double bytes = counts.bytes() + static_cast<double>(build(set).nodes.size() * sizeof(LightNode));
    EXPECT_NEAR(entry.resident_bytes(counts), bytes, 0.03 * bytes);
    EXPECT_GE(entry.peak_bytes(counts), entry.resident_bytes(counts));
  }
}

TEST_P(Builders, SameBitsForAnyNumberOfThreads) {
  TestRandom random(4);
  const VplSet vpls = random_vpls(random, 70000);
  const int threads_before = thread_count();
  set_thread_count(1);
  const LightTree one = build(vpls);
  set_thread_count(7);
  const LightTree seven = build(vpls);
  set_thread_count(threads_before);
  EXPECT_EQ(std::memcmp(one.nodes.data(), seven.nodes.data(), one.nodes.size() * sizeof(LightNode)), 0);
  EXPECT_EQ(std::memcmp(one.set.vpls.data(), seven.set.vpls.data(), one.set.vpls.size() * sizeof(Vpl)), 0);
}

// The property of DESIGN 5: a node's bound is never below the sum of the contributions of its VPLs, and 0 only if all
// of them are 0; finite inside boxes where connections are bounded.
TEST_P(Builders, BoundsHoldForRandomNodesAndReceivers) {
  TestRandom random(5);
  std::size_t cases = 0;
  for (int round = 0; round < 1500; ++round) {
    const float spread = std::exp(4 * random.get1() - 2);
    const bool glossy = round % 2 == 0;
    const LightTree tree = build(random_vpls(random, 1 + random.below(100), spread, glossy));
    for (int k = 0; k < 40; ++k) {
      const ShadedPoint x = random_gather_point(random, 1, glossy);
      const float bound = random.below(3) == 0 ? k_infinity : std::exp(8 * random.get1() - 4);
      std::vector<double> contribution(tree.set.vpls.size());
      for (std::size_t i = 0; i < tree.set.vpls.size(); ++i)
        contribution[i] = static_cast<double>(luminance(unshadowed(x, tree, i, bound)));
      const Receiver r = make_receiver({x, LobeSelection()});
      ChildWeights weights;
      NodeIndex evaluated = LightNode::k_none;
      for_each_child(tree, 0, k_all_lanes, [&](Child child) {
        ++cases;
        double sum = 0;
        for (const std::uint32_t i : vpls_below(tree, child)) sum += contribution[i];
        const float scalar = cluster_bound(cluster_of_lane(tree, child.node, child.lane), r, bound);
        if (std::exchange(evaluated, child.node) != child.node)
          evaluate_children(tree, child.node, {&r, 1}, bound, weights);
        const float simd = weights.bound[child.lane];
        if (std::isfinite(scalar)) {
          ASSERT_NEAR(simd, scalar, 1e-2f * scalar + 1e-6f * cluster_of_lane(tree, child.node, child.lane).flux);
        }
        for (const float b : {scalar, simd}) {
          const double node_bound = static_cast<double>(b) * static_cast<double>(k_inv_pi * k_inv_pi);
          ASSERT_GE(node_bound * (1 + 1e-5), sum);
          if (std::isfinite(bound)) {
            ASSERT_TRUE(std::isfinite(node_bound));
          }
        }
      });
    }
  }
  EXPECT_GT(cases, 1000000u);
}

TEST_P(Builders, DescentFindsEveryVplThatLightsAnyReceiverWithItsProbability) {
  TestRandom random(6);
  constexpr int k_draws = 40000;
  std::vector<double> p_values;
  for (int round = 0; round < 20; ++round) {
    const bool glossy = round % 2 == 0;
    const LightTree tree = build(random_vpls(random, 1 + random.below(24), 1, glossy));
    std::vector<ShadedPoint> points;
    std::vector<Receiver> receivers;
    for (std::size_t k = 0; k < 1 + random.below(4); ++k) {
      points.push_back(random_gather_point(random, 1.5f, glossy));
      receivers.push_back(make_receiver({points.back(), LobeSelection()}));
    }
    const float bound = 0.5f;
    const std::vector<double> probability = descent_law(tree, 0, k_all_lanes, receivers, bound);
    double lost = 1;
    for (const double p : probability) lost -= p;
    EXPECT_GE(lost, -1e-12);
    for (std::size_t i = 0; i < tree.set.vpls.size(); ++i)
      for (const ShadedPoint& x : points)
        if (!is_black(unshadowed(x, tree, i, bound))) {
          EXPECT_GT(probability[i], 0);
        }

    std::vector<double> observed(tree.set.vpls.size() + 1, 0), expected(tree.set.vpls.size() + 1, 0);
    std::uint64_t evaluations = 0;
    LightCut cut;
    find_cut(tree, receivers, bound, {.size = 1}, cut);
    for (int d = 0; d < k_draws && cut.entries.empty(); ++d) ++observed.back();
    for (int d = 0; d < k_draws && !cut.entries.empty(); ++d) {
      const auto sample = descend(tree, cut, cut.entries[0], receivers, bound, random.get1_double(), evaluations);
      ++observed[sample ? sample->vpl : tree.set.vpls.size()];
      if (sample) {
        ASSERT_NEAR(sample->probability, probability[sample->vpl], 1e-9 * sample->probability);
      }
    }
    for (std::size_t i = 0; i < tree.set.vpls.size(); ++i) expected[i] = k_draws * probability[i];
    expected.back() = k_draws * std::max(lost, 0.0);
    if (expected.back() < 1e-6) expected.back() = 0;
    p_values.push_back(chi_square_test(observed, expected).p_value);
  }
  // False-alarm rate 0.1 %.
  EXPECT_GT(*std::min_element(p_values.begin(), p_values.end()), sidak(0.001, p_values.size()));
}

TEST_P(Builders, CutIsADisjointCoverAndAFullCutIsEveryVpl) {
  TestRandom random(7);
  const LightTree tree = build(random_vpls(random, 100));
  const ShadedPoint x = random_gather_point(random, 0.5f);
  const Receiver r = make_receiver({x, LobeSelection()});
  LightCut cut;
  for (const int size : {1, 2, 7, 50, 1000}) {
    find_cut(tree, {&r, 1}, 1, {.size = size}, cut);
    EXPECT_LE(cut.entries.size(), static_cast<std::size_t>(size));
    std::vector<int> covered(tree.set.vpls.size(), 0);
    for (const CutEntry& entry : cut.entries)
      for (const std::uint32_t i : vpls_below(tree, entry.node, entry.lanes)) ++covered[i];
    for (std::size_t i = 0; i < covered.size(); ++i) {
      EXPECT_LE(covered[i], 1);
      if (!is_black(unshadowed(x, tree, i, 1))) {
        EXPECT_EQ(covered[i], 1);
      }
    }
    if (size < 1000) continue;
    for (const CutEntry& entry : cut.entries) EXPECT_EQ(vpls_below(tree, entry.node, entry.lanes).size(), 1u);
  }
}

TEST_P(Builders, ProbabilitiesDoNotDependOnTheUnitOfLength) {
  TestRandom random(8);
  const VplSet vpls = random_vpls(random, 50, 1, true);
  VplSet scaled = vpls;
  constexpr float k_scale = 1024;
  for (Vpl& vpl : scaled.vpls)
    vpl.position = {k_scale * vpl.position.x, k_scale * vpl.position.y, k_scale * vpl.position.z};
  const LightTree tree = build(vpls), large = build(scaled);
  std::vector<Receiver> receivers;
  for (int k = 0; k < 3; ++k) {
    const ShadedPoint x = random_gather_point(random, 1.2f, true);
    receivers.push_back(make_receiver({x, LobeSelection()}));
  }
  std::vector<Receiver> far = receivers;
  for (Receiver& r : far) r.position = {k_scale * r.position.x, k_scale * r.position.y, k_scale * r.position.z};
  for (NodeIndex node = 0; node < tree.nodes.size(); ++node) {
    ChildWeights small_weights, large_weights;
    evaluate_children(tree, node, receivers, 2, small_weights);
    evaluate_children(large, node, far, 2 / (k_scale * k_scale), large_weights);
    const auto small_p = child_probabilities(small_weights, k_all_lanes);
    const auto large_p = child_probabilities(large_weights, k_all_lanes);
    for (int lane = 0; lane < LightNode::k_width; ++lane) EXPECT_NEAR(small_p.lane[lane], large_p.lane[lane], 1e-5);
  }
}

}  // namespace
}  // namespace gradslc
