// What may stop a cut's refinement, and what may happen to samples on the way: cuts by bounds alone leave selection
// unbiased, stopping by sampled values does not; a split may hand samples down only where the law allows.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lighttree/cut.h"
#include "lighttree/descent.h"
#include "random_vpls.h"
#include "support/statistics.h"
#include "tree_walk.h"

namespace gradslc {
namespace {

/// Lambertian VPLs on a thick floor that face +z, and a receiver near by that all of them light: distances to the near
/// and far sides of clusters differ much.
struct LitTree {
  LightTree tree;
  ShadedPoint x;
  Receiver receiver;

  double contribution(std::uint32_t vpl) const {
    return static_cast<double>(luminance(unshadowed(x, tree, vpl, k_infinity)));
  }
  double exact() const {
    double sum = 0;
    for (std::uint32_t i = 0; i < tree.set.vpls.size(); ++i) sum += contribution(i);
    return sum;
  }
  std::span<const Receiver> receivers() const { return {&receiver, 1}; }
  LightCut cut(const CutLimits& limits) const {
    LightCut result;
    find_cut(tree, receivers(), k_infinity, limits, result);
    return result;
  }
  DescentSample draw(const LightCut& cut, const CutEntry& entry, TestRandom& random) const {
    std::uint64_t evaluations = 0;
    return *descend(tree, cut, entry, receivers(), k_infinity, random.get1_double(), evaluations);
  }
};

LitTree lit_tree(TestRandom& random, std::size_t count) {
  VplSet set = random_vpls(random, count);
  for (Vpl& vpl : set.vpls) {
    vpl.position.z *= 0.1f;
    vpl.geometric_normal = vpl.shading_normal = OctahedralNormal({0, 0, 1});
  }
  LitTree lit{builder_registry()[0].build(std::move(set)), {}, {}};
  bool all = false;
  while (!all) {
    lit.x = random_gather_point(random, 1);
    all = true;
    for (std::uint32_t i = 0; i < count && all; ++i) all = lit.contribution(i) > 0;
  }
  lit.receiver = make_receiver({lit.x, LobeSelection()});
  return lit;
}

TEST(CutLimits, NoRefinableBoundIsAboveTheShareOfAll) {
  TestRandom random(1);
  for (int round = 0; round < 200; ++round) {
    const LightTree tree = builder_registry()[0].build(random_vpls(random, 200, 1, round % 2 == 0));
    const ShadedPoint x = random_gather_point(random, 1.5f, round % 2 == 0);
    const Receiver r = make_receiver({x, LobeSelection()});
    const float bound = round % 3 == 0 ? k_infinity : 0.5f;
    LightCut cut, without;
    for (const float error : {1.0f, 0.3f, 0.1f, 0.02f, 0.0f}) {
      find_cut(tree, {&r, 1}, bound, {.size = 150, .error = error}, cut);
      EXPECT_LE(cut.entries.size(), 150u);
      if (cut.entries.size() == 150) continue;
      double sum = 0, largest = 0;
      for (const CutEntry& entry : cut.entries) {
        sum += static_cast<double>(entry.bound);
        if (!is_single_vpl(tree, entry)) largest = std::max(largest, static_cast<double>(entry.bound));
      }
      EXPECT_LE(largest, static_cast<double>(error) * sum * (1 + 1e-5));
      EXPECT_TRUE(std::isfinite(largest));
    }
    // A limit of 0 is no limit.
    find_cut(tree, {&r, 1}, bound, {.size = 150}, without);
    ASSERT_EQ(cut.entries.size(), without.entries.size());
    for (std::size_t i = 0; i < cut.entries.size(); ++i) EXPECT_EQ(cut.entries[i].lanes, without.entries[i].lanes);
  }
}

/// Sum over a cut of one sample for every entry, over its probability; and the largest of the terms.
struct SampledCut {
  double total = 0, largest = 0;
};
SampledCut sample_cut(const LitTree& lit, const LightCut& cut, TestRandom& random) {
  SampledCut sampled;
  for (const CutEntry& entry : cut.entries) {
    const DescentSample sample = lit.draw(cut, entry, random);
    const double value = lit.contribution(sample.vpl) / sample.probability;
    sampled.total += value;
    sampled.largest = std::max(sampled.largest, value);
  }
  return sampled;
}

// DESIGN 5: refining until the samples look good keeps the totals that happen to look good.
TEST(StoppingRules, SampledValuesBiasTheEstimateAndBoundsDoNot) {
  TestRandom random(2);
  const LitTree lit = lit_tree(random, 60);
  constexpr float k_share = 0.3f;
  constexpr int k_most = 12, k_runs = 40000;
  std::vector<LightCut> cuts;
  for (int size = 1; size <= k_most; ++size) cuts.push_back(lit.cut({.size = size}));
  const LightCut by_bounds = lit.cut({.size = k_most, .error = k_share});
  EXPECT_GT(by_bounds.entries.size(), 1u);
  EXPECT_LT(by_bounds.entries.size(), static_cast<std::size_t>(k_most));

  Moments sampled_rule, bound_rule;
  for (int run = 0; run < k_runs; ++run) {
    SampledCut sampled;
    for (const LightCut& cut : cuts) {
      sampled = sample_cut(lit, cut, random);
      if (sampled.largest <= static_cast<double>(k_share) * sampled.total) break;
    }
    sampled_rule.add(sampled.total);
    bound_rule.add(sample_cut(lit, by_bounds, random).total);
  }
  const double exact = lit.exact();
  EXPECT_GT(std::abs(sampled_rule.mean() - exact) / sampled_rule.standard_error(), 6);
  EXPECT_GT(bound_rule.p_value(exact), 0.001);  // false-alarm rate 0.1 %
}

/// The law of the VPL drawn for an entry.
enum class EntryLaw : std::uint8_t {
  descent,     ///< as descend() draws: child_probabilities() of the entry's lanes
  conditional  ///< what descent from the whole node draws, given that it lies in the entry
};

class Inheritance : public testing::Test {
 protected:
  TestRandom random_{3};
  LitTree lit_ = lit_tree(random_, 64);  // eight nodes of eight below the root

  std::vector<double> law(const CutEntry& entry, EntryLaw kind) const {
    if (kind == EntryLaw::descent) return descent_law(lit_.tree, entry.node, entry.lanes, lit_.receivers(), k_infinity);
    std::vector<double> whole = descent_law(lit_.tree, entry.node, k_all_lanes, lit_.receivers(), k_infinity);
    std::vector<double> given(whole.size(), 0);
    double sum = 0;
    for (const std::uint32_t i : vpls_below(lit_.tree, entry.node, entry.lanes)) sum += given[i] = whole[i];
    for (double& p : given) p /= sum;
    return given;
  }

  /// One VPL for every entry of the cut of `size`, drawn at the root and handed down: the part that the sample lies in
  /// keeps it, the other draws its own.
  std::vector<std::uint32_t> draw_inherited(std::size_t size, EntryLaw kind) {
    LightCut cut;
    ClusterSplitter splitter(lit_.tree, lit_.receivers(), k_infinity, cut.evaluated);
    std::vector<std::uint32_t> samples;
    const auto draw = [&](const CutEntry& entry) {
      if (kind == EntryLaw::descent) return lit_.draw(cut, entry, random_).vpl;
      const std::vector<std::uint32_t> below = vpls_below(lit_.tree, entry.node, entry.lanes);
      const CutEntry node{entry.node, whole_node(entry.node), entry.evaluated, 0};
      std::uint32_t vpl = 0;
      do vpl = lit_.draw(cut, node, random_).vpl;
      while (std::find(below.begin(), below.end(), vpl) == below.end());
      return vpl;
    };
    for (const CutEntry& root : splitter.root()) cut.entries.push_back(root), samples.push_back(draw(root));
    while (cut.entries.size() < size) {
      const std::size_t widest = widest_entry(cut);
      const CutEntry parent = cut.entries[widest];
      const std::uint32_t inherited = samples[widest];
      cut.entries.erase(cut.entries.begin() + static_cast<std::ptrdiff_t>(widest));
      samples.erase(samples.begin() + static_cast<std::ptrdiff_t>(widest));
      for (const CutEntry& part : splitter.split(parent)) {
        const std::vector<std::uint32_t> below = vpls_below(lit_.tree, part.node, part.lanes);
        const bool keeps = std::find(below.begin(), below.end(), inherited) != below.end();
        cut.entries.push_back(part), samples.push_back(keeps ? inherited : draw(part));
      }
    }
    entries_ = cut.entries;
    return samples;
  }

  LaneMask whole_node(NodeIndex node) const {
    LaneMask lanes = 0;
    for (int lane = 0; lane < LightNode::k_width; ++lane)
      if (lit_.tree.nodes[node].has_child(lane)) lanes |= LaneMask{1} << lane;
    return lanes;
  }
  std::size_t widest_entry(const LightCut& cut) const {
    std::size_t widest = cut.entries.size();
    for (std::size_t i = 0; i < cut.entries.size(); ++i)
      if (!is_single_vpl(lit_.tree, cut.entries[i]) &&
          (widest == cut.entries.size() || cut.entries[i].bound > cut.entries[widest].bound))
        widest = i;
    return widest;
  }

  /// p-value of "the samples of a cut of two entries are independent, each by its entry's law": over all pairs.
  double joint_p_value(EntryLaw kind) {
    constexpr int k_draws = 60000;
    const std::size_t count = lit_.tree.set.vpls.size();
    std::vector<double> observed(count * count, 0), expected(count * count, 0);
    for (int i = 0; i < k_draws; ++i) {
      const auto samples = draw_inherited(2, kind);
      ++observed[samples[0] * count + samples[1]];
    }
    const std::vector<double> first = law(entries_[0], kind), second = law(entries_[1], kind);
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b) expected[a * count + b] = k_draws * first[a] * second[b];
    return chi_square_test(observed, expected).p_value;
  }

  /// Smallest p-value over the entries of a cut of five of "its sample has the entry's law".
  double least_p_value(EntryLaw kind) {
    constexpr int k_draws = 60000;
    const std::size_t count = lit_.tree.set.vpls.size();
    std::vector<std::vector<double>> observed(k_entries, std::vector<double>(count, 0));
    for (int i = 0; i < k_draws; ++i) {
      const auto samples = draw_inherited(k_entries, kind);
      for (std::size_t e = 0; e < k_entries; ++e) ++observed[e][samples[e]];
    }
    double least = 1;
    for (std::size_t e = 0; e < k_entries; ++e) {
      std::vector<double> expected = law(entries_[e], kind);
      for (double& p : expected) p *= k_draws;
      least = std::min(least, chi_square_test(observed[e], expected).p_value);
    }
    return least;
  }

  static constexpr std::size_t k_entries = 5;
  std::vector<CutEntry> entries_;
};

// Where a part's law is its parent's given the part, handing down changes nothing: samples of the entries are
// independent and have the law of fresh draws. False-alarm rate 0.1 %.
TEST_F(Inheritance, HasTheLawOfFreshDrawsWhereLawsNest) {
  EXPECT_GT(joint_p_value(EntryLaw::conditional), sidak(0.001, 1 + k_entries));
  EXPECT_GT(least_p_value(EntryLaw::conditional), sidak(0.001, 1 + k_entries));
}

// Halves of a node's children renormalise nearest and farthest importance each by itself: their laws do not nest, and
// samples handed down would not have the probability that descent states. A single child's node has the child's law.
TEST_F(Inheritance, LawsNestBetweenLevelsAndNotBetweenHalvesOfANode) {
  const LightNode& root = lit_.tree.nodes[0];
  ASSERT_TRUE(root.has_child(7) && !root.is_leaf(7));
  std::vector<ChildWeights> evaluated;
  ClusterSplitter splitter(lit_.tree, lit_.receivers(), k_infinity, evaluated);
  double largest_difference = 0;
  for (const CutEntry& half : splitter.split(splitter.root().parts[0])) {
    const std::vector<double> stated = law(half, EntryLaw::descent), inherited = law(half, EntryLaw::conditional);
    double difference = 0;  // total variation
    for (std::size_t i = 0; i < stated.size(); ++i) difference += 0.5 * std::abs(stated[i] - inherited[i]);
    largest_difference = std::max(largest_difference, difference);
  }
  EXPECT_GT(largest_difference, 1e-3);

  const CutEntry child{0, 0b10000000, 0, 0};
  const std::vector<double> above = law(child, EntryLaw::descent);
  const std::vector<double> below = law({root.child[7], k_all_lanes, 0, 0}, EntryLaw::descent);
  for (std::size_t i = 0; i < above.size(); ++i) EXPECT_NEAR(above[i], below[i], 1e-12);
}

}  // namespace
}  // namespace gradslc
