#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/bounds.h"
#include "lighttree/light_tree.h"

namespace gradslc {

/// A VPL, or some of them, as splitting sees it. A box of three values is held as lower bounds and negated upper ones,
/// so that one minimum joins two.
struct SplitItem {
  alignas(32) float box[8] = {}, normals[8] = {};  ///< of positions and of normals; the last two are 0
  float centre[3] = {};                            ///< where it is sorted by
  float flux = 0;
};
SplitItem make_split_item(const Vpl& vpl);
/// Not of an empty span.
SplitItem make_split_item(std::span<const SplitItem> items);

/// Which items lie below which nodes of eight children: what a tree is before it is filled.
struct Topology {
  struct Leaf {
    std::uint32_t begin, end;  ///< places in `order`
  };
  struct Node {
    static constexpr std::uint32_t k_leaf = 0x80000000u;
    std::uint32_t child[LightNode::k_width];  ///< k_leaf | index of a leaf, or of a node that comes later
    int count = 0;
  };
  std::vector<Node> nodes;  ///< the root first; none where there is one leaf only
  std::vector<Leaf> leaves;
  std::vector<std::uint32_t> order;  ///< indices of items
};

/// Splits items top-down by the surface area orientation heuristic with bins along the axes (Conty Estevez and Kulla
/// 2018): a split costs, on both sides together, flux x extent x spread of directions. A node's ranges are split, the
/// costliest first, until there are eight. Leaves have `leaf_size` items but for the last of all; the smaller side of a
/// split has a sixteenth of the items at least, which bounds the depth. Where nothing tells items apart they are
/// split by count. Reuses `topology`'s memory. One per thread.
class SaohSplitter {
 public:
  explicit SaohSplitter(std::uint32_t leaf_size) : leaf_size_(leaf_size) {}
  void split(std::span<const SplitItem> items, Topology& topology);

 private:
  struct Range {
    std::uint32_t begin, end;
    float cost;
    std::uint32_t count() const { return end - begin; }
    /// By cost; among equals, as where all is black, by count.
    bool is_below(const Range& o) const { return cost != o.cost ? cost < o.cost : count() < o.count(); }
  };
  struct Plane {
    int axis = -1;
    std::uint32_t left_count = 0;
    float cost = 0;
  };
  Range make_range(std::uint32_t begin, std::uint32_t end) const;
  std::uint32_t split_range(const Range& range);
  Plane best_plane(const Range& range, const Bounds3& centres) const;
  std::uint32_t allowed_left_count(std::uint32_t left, std::uint32_t count) const;
  void partition(const Range& range, int axis, std::uint32_t left_count);

  struct SortKey {
    float coordinate;
    std::uint32_t item;
    bool operator<(const SortKey& o) const {
      return coordinate != o.coordinate ? coordinate < o.coordinate : item < o.item;
    }
  };

  std::uint32_t leaf_size_;
  std::span<const SplitItem> items_;
  Topology* topology_ = nullptr;
  std::vector<Range> node_ranges_;
  std::vector<SortKey> keys_;
};

}  // namespace gradslc
