#include "lighttree/builders/saoh_topology.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/rgb.h"
#include "core/simd.h"

namespace gradslc {
namespace {

/// Half the surface area and the squared diagonal: points on a line have an extent, too.
float extent_measure(const float (&box)[8]) {
  const float x = -box[3] - box[0], y = -box[4] - box[1], z = -box[5] - box[2];
  return x * y + y * z + z * x + x * x + y * y + z * z;
}

/// Conty Estevez and Kulla's M_Omega for Lambertian emitters and a cone of half angle t around their normals,
///   2 pi (1 - cos t) + pi cos t + pi^2 / 2 sin t   for t <= pi/2,
/// and 4 pi beyond that. The cone is the one of the sphere around the normals' box.
float orientation_measure(const float (&box)[8]) {
  float centre2 = 0, radius2 = 0;
  for (int i = 0; i < 3; ++i) {
    const float centre = 0.5f * (box[i] - box[i + 3]), half = 0.5f * (-box[i + 3] - box[i]);
    centre2 += centre * centre, radius2 += half * half;
  }
  if (radius2 >= centre2) return 4 * k_pi;
  const float sine2 = radius2 / centre2;
  return k_pi * (2 - std::sqrt(1 - sine2)) + 0.5f * k_pi * k_pi * std::sqrt(sine2);
}

/// Some items together.
struct Group {
  Float8 box = k_infinity, normals = k_infinity;
  float flux = 0;
  std::uint32_t count = 0;

  void add(const SplitItem& item) {
    box = stdx::min(box, load_aligned(item.box)), normals = stdx::min(normals, load_aligned(item.normals));
    flux += item.flux;
    ++count;
  }
  void add(const Group& o) {
    box = stdx::min(box, o.box), normals = stdx::min(normals, o.normals);
    flux += o.flux;
    count += o.count;
  }
  float cost() const {
    alignas(32) float positions[8], directions[8];
    box.copy_to(positions, stdx::vector_aligned), normals.copy_to(directions, stdx::vector_aligned);
    return flux * extent_measure(positions) * orientation_measure(directions);
  }
};

constexpr std::size_t k_most_bins = 16;
using Bins = std::array<Group, k_most_bins>;

}  // namespace

SplitItem make_split_item(const Vpl& vpl) {
  const Vec3 normal = vpl.geometric_normal.decode();
  SplitItem item;
  for (int axis = 0; axis < 3; ++axis) {
    item.centre[axis] = item.box[axis] = vpl.position[axis];
    item.box[axis + 3] = -vpl.position[axis];
    item.normals[axis] = normal[axis], item.normals[axis + 3] = -normal[axis];
  }
  item.flux = luminance(vpl.flux);
  return item;
}

SplitItem make_split_item(std::span<const SplitItem> items) {
  Group group;
  for (const SplitItem& item : items) group.add(item);
  SplitItem joined;
  group.box.copy_to(joined.box, stdx::vector_aligned), group.normals.copy_to(joined.normals, stdx::vector_aligned);
  for (int axis = 0; axis < 3; ++axis) joined.centre[axis] = 0.5f * (joined.box[axis] - joined.box[axis + 3]);
  joined.flux = group.flux;
  return joined;
}

void SaohSplitter::split(std::span<const SplitItem> items, Topology& topology) {
  items_ = items, topology_ = &topology;
  const auto count = static_cast<std::uint32_t>(items.size());
  topology.nodes.clear(), topology.leaves.clear();
  topology.order.resize(count);
  std::iota(topology.order.begin(), topology.order.end(), 0u);
  node_ranges_.clear();
  const auto add_leaf = [&](std::uint32_t begin, std::uint32_t end) {
    // Items come in an order of their own, neighbours close to each other.
    std::sort(topology.order.begin() + begin, topology.order.begin() + end);
    topology.leaves.push_back({begin, end});
  };
  if (count <= leaf_size_)
    add_leaf(0, count);
  else
    node_ranges_.push_back({0, count, 0});
  for (std::size_t node = 0; node < node_ranges_.size(); ++node) {
    std::array<Range, LightNode::k_width> ranges{node_ranges_[node]};
    std::size_t used = 1;
    while (used < ranges.size()) {
      std::size_t costliest = used;
      for (std::size_t i = 0; i < used; ++i)
        if (ranges[i].count() > leaf_size_ && (costliest == used || ranges[costliest].is_below(ranges[i])))
          costliest = i;
      if (costliest == used) break;
      const Range parent = ranges[costliest];
      const std::uint32_t middle = split_range(parent);
      std::move_backward(ranges.begin() + static_cast<std::ptrdiff_t>(costliest) + 1,
                         ranges.begin() + static_cast<std::ptrdiff_t>(used),
                         ranges.begin() + static_cast<std::ptrdiff_t>(used) + 1);
      ranges[costliest] = make_range(parent.begin, middle);
      ranges[costliest + 1] = make_range(middle, parent.end);
      ++used;
    }
    Topology::Node& made = topology.nodes.emplace_back();
    for (const Range& range : std::span(ranges).first(used)) {
      if (range.count() <= leaf_size_) {
        made.child[made.count++] = Topology::Node::k_leaf | static_cast<std::uint32_t>(topology.leaves.size());
        add_leaf(range.begin, range.end);
      } else {
        made.child[made.count++] = static_cast<std::uint32_t>(node_ranges_.size());
        node_ranges_.push_back(range);
      }
    }
  }
}

SaohSplitter::Range SaohSplitter::make_range(std::uint32_t begin, std::uint32_t end) const {
  if (end - begin <= leaf_size_) return {begin, end, 0};
  Group group;
  for (std::uint32_t i = begin; i < end; ++i) group.add(items_[topology_->order[i]]);
  return {begin, end, group.cost()};
}

/// Reorders the range; the first place of its right side.
std::uint32_t SaohSplitter::split_range(const Range& range) {
  Bounds3 centres;
  for (std::uint32_t i = range.begin; i < range.end; ++i) {
    const float(&centre)[3] = items_[topology_->order[i]].centre;
    centres.extend(Point3{centre[0], centre[1], centre[2]});
  }
  Plane plane = best_plane(range, centres);
  if (plane.axis < 0 || plane.cost == 0) {
    const Vec3 extent = centres.diagonal();
    plane.axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    plane.left_count = range.count() / 2;
  }
  const std::uint32_t left_count = allowed_left_count(plane.left_count, range.count());
  partition(range, plane.axis, left_count);
  return range.begin + left_count;
}

SaohSplitter::Plane SaohSplitter::best_plane(const Range& range, const Bounds3& centres) const {
  const std::size_t bin_count = range.count() <= 64 ? 8 : k_most_bins;
  const Vec3 extent = centres.diagonal();
  const float longest = max_component(extent);
  Plane best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(extent[axis] > 0)) continue;
    const float lower = centres.lower[axis], bins_per_length = static_cast<float>(bin_count) / extent[axis];
    Bins bins;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const SplitItem& item = items_[topology_->order[i]];
      const auto bin = static_cast<std::size_t>((item.centre[axis] - lower) * bins_per_length);
      bins[std::min(bin, bin_count - 1)].add(item);
    }
    std::array<float, k_most_bins> right_cost;
    Group right;
    for (std::size_t bin = bin_count; bin-- > 1;) {
      right.add(bins[bin]);
      right_cost[bin] = right.count > 0 ? right.cost() : 0;
    }
    // Cutting an axis shorter than the longest leaves thin boxes.
    const float shape = longest / extent[axis];
    Group left;
    for (std::size_t bin = 1; bin < bin_count; ++bin) {
      left.add(bins[bin - 1]);
      if (left.count == 0 || left.count == range.count()) continue;
      const float cost = shape * (left.cost() + right_cost[bin]);
      if (best.axis < 0 || cost < best.cost) best = {axis, left.count, cost};
    }
  }
  return best;
}

std::uint32_t SaohSplitter::allowed_left_count(std::uint32_t left, std::uint32_t count) const {
  const std::uint32_t share = count / 16;
  const std::uint32_t least = std::max(leaf_size_, (share + leaf_size_ - 1) / leaf_size_ * leaf_size_);
  const std::uint32_t most = std::min(count - 1, count - share) / leaf_size_ * leaf_size_;
  return std::clamp((left + leaf_size_ / 2) / leaf_size_ * leaf_size_, least, most);
}

void SaohSplitter::partition(const Range& range, int axis, std::uint32_t left_count) {
  keys_.clear();
  for (std::uint32_t i = range.begin; i < range.end; ++i)
    keys_.push_back({items_[topology_->order[i]].centre[axis], topology_->order[i]});
  std::nth_element(keys_.begin(), keys_.begin() + left_count, keys_.end());
  for (std::uint32_t i = 0; i < keys_.size(); ++i) topology_->order[range.begin + i] = keys_[i].item;
}

}  // namespace gradslc
