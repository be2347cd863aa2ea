#include "lighttree/builders/saoh.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "core/parallel.h"
#include "lighttree/builders/morton_order.h"
#include "lighttree/builders/saoh_topology.h"
#include "lighttree/fill_node.h"

namespace gradslc {
namespace {

constexpr std::size_t k_chunk = std::size_t{1} << 15;  // VPLs whose runs one thread makes; runs end with it
constexpr std::size_t k_shortest_run = 256, k_longest_run = 512;

/// VPLs in Morton order that are split on their own.
struct Run {
  std::size_t begin = 0;
  Topology topology;
  SplitItem whole;
  NodeIndex root = 0;

  std::size_t node_count() const { return topology.nodes.size() + topology.leaves.size(); }
};

/// The end of the run that begins at `begin`: where the widest step of the curve lies, the highest bit in which
/// neighbours' cells differ.
std::size_t run_end(std::span<const std::uint64_t> codes, std::size_t begin) {
  if (codes.size() - begin <= k_longest_run) return codes.size();
  std::size_t end = begin + k_longest_run;
  int widest = -1;
  for (std::size_t i = begin + k_shortest_run; i <= begin + k_longest_run; ++i)
    if (const int width = std::bit_width(codes[i - 1] ^ codes[i]); width > widest) widest = width, end = i;
  return end;
}

void put_in_order(std::span<Vpl> vpls, std::span<const std::uint32_t> order, std::vector<Vpl>& buffer) {
  buffer.clear();
  for (const std::uint32_t i : order) buffer.push_back(vpls[i]);
  std::copy(buffer.begin(), buffer.end(), vpls.begin());
}

/// Splits the runs of some VPLs, which are brought into the tree's order.
std::vector<Run> make_runs(std::span<Vpl> vpls, std::size_t first, const MortonCode& code) {
  std::vector<std::uint64_t> codes;
  codes.reserve(vpls.size());
  for (const Vpl& vpl : vpls) codes.push_back(code(vpl.position));
  std::vector<Run> runs;
  SaohSplitter splitter(LightNode::k_width);
  std::vector<SplitItem> items;
  std::vector<Vpl> buffer;
  for (std::size_t begin = 0, end = 0; begin < vpls.size(); begin = end) {
    end = run_end(codes, begin);
    items.clear();
    for (const Vpl& vpl : vpls.subspan(begin, end - begin)) items.push_back(make_split_item(vpl));
    Run& run = runs.emplace_back();
    run.begin = first + begin;
    run.whole = make_split_item(items);
    splitter.split(items, run.topology);
    put_in_order(vpls.subspan(begin, end - begin), run.topology.order, buffer);
    run.topology.order = {};
  }
  return runs;
}

/// Fills the nodes of a topology, children first. Leaf i is the node leaf_node(i), filled already.
template <class LeafNode>
void fill_inner_nodes(LightTree& tree, const Topology& topology, NodeIndex root, const LeafNode& leaf_node) {
  for (std::size_t i = topology.nodes.size(); i-- > 0;) {
    const Topology::Node& node = topology.nodes[i];
    NodeIndex children[LightNode::k_width];
    for (int lane = 0; lane < node.count; ++lane) {
      const std::uint32_t child = node.child[lane];
      children[lane] =
          (child & Topology::Node::k_leaf) != 0 ? leaf_node(child & ~Topology::Node::k_leaf) : root + child;
    }
    fill_inner_node(tree, root + static_cast<NodeIndex>(i),
                    std::span(children).first(static_cast<std::size_t>(node.count)));
  }
}

void fill_run(LightTree& tree, const Run& run) {
  const Topology& topology = run.topology;
  const auto leaf_node = [&](std::uint32_t leaf) {
    return run.root + static_cast<NodeIndex>(topology.nodes.size()) + leaf;
  };
  for (std::uint32_t leaf = 0; leaf < topology.leaves.size(); ++leaf) {
    const auto [begin, end] = topology.leaves[leaf];
    fill_leaf_node(tree, leaf_node(leaf), static_cast<std::uint32_t>(run.begin + begin), static_cast<int>(end - begin));
  }
  fill_inner_nodes(tree, topology, run.root, leaf_node);
}

/// Nodes for each VPL, as found on walls of rooms: an eighth are leaves' nodes.
constexpr double k_nodes_per_vpl = 0.1545;
constexpr double k_topology_bytes = 3;  // for each VPL

}  // namespace

double saoh_bytes(const VplCounts& counts) {
  return counts.bytes() + counts.vpls * k_nodes_per_vpl * node_bytes(counts);
}

double saoh_peak_bytes(const VplCounts& counts) {
  return std::max(saoh_bytes(counts) + counts.vpls * k_topology_bytes,
                  counts.bytes() + counts.vpls * static_cast<double>(k_morton_bytes));
}

LightTree build_saoh(VplSet set) {
  LightTree tree;
  tree.set = std::move(set);
  const std::span<Vpl> vpls = tree.set.vpls;
  if (vpls.empty()) return tree;
  {
    BulkVector<std::byte> scratch(vpls.size() * k_morton_bytes);
    sort_in_morton_order(vpls, scratch);
  }

  const MortonCode code(box_of(vpls));
  std::vector<std::vector<Run>> chunks((vpls.size() + k_chunk - 1) / k_chunk);
  parallel_for(vpls.size(), k_chunk, [&](std::size_t begin, std::size_t end) {
    chunks[begin / k_chunk] = make_runs(vpls.subspan(begin, end - begin), begin, code);
  });

  std::vector<SplitItem> wholes;
  for (const std::vector<Run>& runs : chunks)
    for (const Run& run : runs) wholes.push_back(run.whole);
  Topology upper;
  SaohSplitter(1).split(wholes, upper);

  // The upper nodes come first, so that the root does; then those of each run.
  std::size_t count = upper.nodes.size();
  std::vector<NodeIndex> run_roots;
  for (std::vector<Run>& runs : chunks)
    for (Run& run : runs) {
      run.root = static_cast<NodeIndex>(count);
      run_roots.push_back(run.root);
      count += run.node_count();
    }
  resize_nodes(tree, count);
  parallel_for(chunks.size(), 1, [&](std::size_t chunk, std::size_t) {
    for (const Run& run : chunks[chunk]) fill_run(tree, run);
    chunks[chunk] = {};
  });
  fill_inner_nodes(tree, upper, 0,
                   [&](std::uint32_t leaf) { return run_roots[upper.order[upper.leaves[leaf].begin]]; });
  return tree;
}

}  // namespace gradslc
