#include "lighttree/builders/saoh_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/random.h"

namespace gradslc {
namespace {

SplitItem item_at(Point3 position, float flux, Normal3 normal = {0, 0, 1}) {
  Vpl vpl;
  vpl.position = position;
  vpl.flux = Rgb(flux);
  vpl.geometric_normal = OctahedralNormal(as_vec(normal));
  return make_split_item(vpl);
}

int depth_of(const Topology& topology) {
  std::vector<int> depth(topology.nodes.size(), 1);
  for (std::size_t i = 0; i < topology.nodes.size(); ++i)
    for (int lane = 0; lane < topology.nodes[i].count; ++lane)
      if (const std::uint32_t child = topology.nodes[i].child[lane]; (child & Topology::Node::k_leaf) == 0)
        depth[child] = depth[i] + 1;
  return depth.empty() ? 0 : *std::max_element(depth.begin(), depth.end());
}

TEST(SaohSplitter, BlackItemsAreSplitByCount) {
  TestRandom random(1);
  std::vector<SplitItem> items;
  for (int i = 0; i < 4096; ++i) items.push_back(item_at({random.get1(), random.get1(), random.get1()}, 0));
  Topology topology;
  SaohSplitter(1).split(items, topology);
  EXPECT_EQ(topology.leaves.size(), 4096u);
  EXPECT_EQ(depth_of(topology), 4);
}

TEST(SaohSplitter, PositionsThatConvergeDoNotMakeItDeep) {
  std::vector<SplitItem> items;
  for (int i = 0; i < 4000; ++i) items.push_back(item_at({std::exp(-0.02f * static_cast<float>(i)), 0, 0}, 1));
  Topology topology;
  SaohSplitter(1).split(items, topology);
  EXPECT_LE(depth_of(topology), 20);
}

TEST(SaohSplitter, LeavesAreFullAndHoldEveryItem) {
  TestRandom random(2);
  std::vector<SplitItem> items;
  for (int i = 0; i < 509; ++i) items.push_back(item_at({random.get1(), random.get1(), 0}, random.get1()));
  Topology topology;
  SaohSplitter(8).split(items, topology);
  EXPECT_EQ(topology.leaves.size(), 64u);
  std::sort(topology.order.begin(), topology.order.end());
  for (std::uint32_t i = 0; i < 509; ++i) ASSERT_EQ(topology.order[i], i);
}

// Two walls that interpenetrate: where positions do not tell groups apart, directions must. They differ along x, where
// the box is shorter than along y.
TEST(SaohSplitter, WallsOfDifferentNormalsAreSeparated) {
  TestRandom random(3);
  std::vector<SplitItem> items;
  for (int i = 0; i < 400; ++i) {
    const bool right = i % 2 == 1;
    items.push_back(item_at({right ? 0.51f + 0.4f * random.get1() : 0.09f + 0.4f * random.get1(), random.get1(), 0}, 1,
                            right ? Normal3{1, 0, 0} : Normal3{-1, 0, 0}));
  }
  Topology topology;
  SaohSplitter(1).split(items, topology);
  // The first split is by normals: no lane of the root mixes them.
  ASSERT_FALSE(topology.nodes.empty());
  std::vector<bool> right_side(topology.order.size());
  for (std::size_t place = 0; place < topology.order.size(); ++place)
    right_side[place] = topology.order[place] % 2 == 1;
  const auto changes = std::inner_product(right_side.begin() + 1, right_side.end(), right_side.begin(), 0,
                                          std::plus<>(), std::not_equal_to<>());
  EXPECT_EQ(changes, 1);
}

}  // namespace
}  // namespace gradslc
