#include "lighttree/fill_node.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/rgb.h"
#include "core/simd.h"

namespace gradslc {
namespace {

using Lanes = LightNode::Lanes;
using LaneSelection = Float8::mask_type;

/// Components of some VPLs, side by side.
struct VplLanes {
  alignas(32) Lanes position[3] = {}, flux = {}, max_pi_f = {};
  alignas(32) Lanes geometric[2] = {}, shading[2] = {};  // octahedral, as stored
};

VplLanes gather(const Vpl* vpls, int count) {
  VplLanes lanes;
  for (int i = 0; i < count; ++i) {
    const Vpl& vpl = vpls[i];
    for (int axis = 0; axis < 3; ++axis) lanes.position[axis][i] = vpl.position[axis];
    lanes.flux[i] = luminance(vpl.flux);
    lanes.max_pi_f[i] = vpl.max_pi_f;
    for (int axis = 0; axis < 2; ++axis) {
      lanes.geometric[axis][i] = static_cast<float>(vpl.geometric_normal.stored(axis));
      lanes.shading[axis][i] = static_cast<float>(vpl.shading_normal.stored(axis));
    }
  }
  return lanes;
}

/// As OctahedralNormal::decode(), to the bit.
void decode(const Lanes (&stored)[2], Float8 (&normal)[3]) {
  Float8 x = load_aligned(stored[0]) / 32767.0f, y = load_aligned(stored[1]) / 32767.0f;
  const Float8 z = 1.0f - stdx::abs(x) - stdx::abs(y);
  const Float8 fold = stdx::max(-z, Float8(0));
  x -= stdx::copysign(fold, x), y -= stdx::copysign(fold, y);
  const Float8 length = stdx::sqrt(x * x + y * y + z * z);
  normal[0] = x / length, normal[1] = y / length, normal[2] = z / length;
}

void fill_lambert_lanes(LightNode& node, const Vpl* vpls, int count) {
  const VplLanes lanes = gather(vpls, count);
  Float8 geometric[3], shading[3];
  decode(lanes.geometric, geometric), decode(lanes.shading, shading);
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 position = load_aligned(lanes.position[axis]);
    position.copy_to(node.lower[axis], stdx::vector_aligned);
    position.copy_to(node.upper[axis], stdx::vector_aligned);
    geometric[axis].copy_to(node.axis[axis], stdx::vector_aligned);
  }
  const Float8 flux = load_aligned(lanes.flux), max_pi_f = load_aligned(lanes.max_pi_f);
  Float8 capped = flux / max_pi_f;
  stdx::where(!(max_pi_f > 0), capped) = 0;
  const Float8 cos_normals = geometric[0] * shading[0] + geometric[1] * shading[1] + geometric[2] * shading[2];
  const Float8 facing = stdx::max(cos_normals, Float8(0));
  Float8 cosine = stdx::max(2 * facing * facing - 1 - k_cone_rounding, Float8(-1));
  stdx::where(load_aligned(lanes.geometric[0]) == load_aligned(lanes.shading[0]) &&
                  load_aligned(lanes.geometric[1]) == load_aligned(lanes.shading[1]),
              cosine) = 1;
  flux.copy_to(node.flux, stdx::vector_aligned);
  capped.copy_to(node.capped_flux, stdx::vector_aligned);
  cosine.copy_to(node.cosine, stdx::vector_aligned);
  stdx::sqrt(stdx::max(1 - cosine * cosine, Float8(0))).copy_to(node.sine, stdx::vector_aligned);
}

/// The cone around the mean of the selected cones' axes that holds them all. Half angles add by cosines and sines; what
/// exceeds pi is the whole sphere.
Cone merge_cones(const Lanes (&axis)[3], const Lanes& cosine, const Lanes& sine, LaneSelection selected) {
  const Cone whole{{0, 0, 1}, -1};
  const Float8 direction[3] = {load_aligned(axis[0]), load_aligned(axis[1]), load_aligned(axis[2])};
  float sum[3];
  for (int i = 0; i < 3; ++i) {
    Float8 counted = 0;
    stdx::where(selected, counted) = direction[i];
    sum[i] = stdx::reduce(counted);
  }
  const Vec3 total{sum[0], sum[1], sum[2]};
  const float squared = length_squared(total);
  const Float8 own_cosine = load_aligned(cosine), own_sine = load_aligned(sine);
  if (stdx::any_of(selected && own_cosine <= -1) || !(squared > 1e-8f)) return whole;
  const Vec3 mean = total / std::sqrt(squared);
  const Float8 cos_offset = stdx::min(direction[0] * mean.x + direction[1] * mean.y + direction[2] * mean.z, Float8(1));
  if (stdx::any_of(selected && cos_offset + own_cosine <= 0)) return whole;  // the two angles together reach pi
  const Float8 sin_offset = stdx::sqrt(stdx::max(1 - cos_offset * cos_offset, Float8(0)));
  Float8 opened = cos_offset * own_cosine - sin_offset * own_sine;
  stdx::where(!selected, opened) = 1;
  return {mean, std::max(-1.0f, std::min(1.0f, stdx::hmin(opened)) - k_cone_rounding)};
}

LaneSelection first_lanes(int count) {
  return Float8([](auto lane) { return static_cast<float>(lane); }) < static_cast<float>(count);
}

}  // namespace

void resize_nodes(LightTree& tree, std::size_t count) {
  tree.nodes.resize(count);
  if (!tree.set.surfaces.empty()) tree.gloss.resize(count);
}

void fill_leaf_node(LightTree& tree, NodeIndex index, std::uint32_t first, int count) {
  assert(count >= 1 && count <= LightNode::k_width);
  LightNode& node = tree.nodes[index];
  GlossyLanes* gloss = tree.gloss.empty() ? nullptr : &tree.gloss[index];
  const Vpl* vpls = tree.set.vpls.data() + first;
  if (std::all_of(vpls, vpls + count, [](const Vpl& vpl) { return vpl.is_lambert(); })) {
    fill_lambert_lanes(node, vpls, count);
    for (int lane = 0; lane < count; ++lane)
      node.child[lane] = LightNode::k_leaf | (first + static_cast<std::uint32_t>(lane));
    clear_lanes(node, nullptr, count);
    if (gloss) *gloss = GlossyLanes();
    return;
  }
  for (int lane = 0; lane < count; ++lane)
    set_lane(node, gloss, lane, make_cluster(tree.set, vpls[lane]),
             LightNode::k_leaf | (first + static_cast<std::uint32_t>(lane)));
  clear_lanes(node, gloss, count);
}

void fill_inner_node(LightTree& tree, NodeIndex index, std::span<const NodeIndex> children) {
  assert(!children.empty() && children.size() <= LightNode::k_width);
  LightNode& node = tree.nodes[index];
  GlossyLanes* gloss = tree.gloss.empty() ? nullptr : &tree.gloss[index];
  int lane = 0;
  for (const NodeIndex child : children) set_lane(node, gloss, lane++, merge_lanes(tree, child), child);
  clear_lanes(node, gloss, lane);
}

LightCluster merge_lanes(const LightTree& tree, NodeIndex index) {
  const LightNode& node = tree.nodes[index];
  LightCluster merged;
  const int count = node.child_count();
  const LaneSelection children = first_lanes(count);
  float lower[3], upper[3];
  for (int axis = 0; axis < 3; ++axis) {
    Float8 low = k_infinity, high = -k_infinity;
    stdx::where(children, low) = load_aligned(node.lower[axis]);
    stdx::where(children, high) = load_aligned(node.upper[axis]);
    lower[axis] = stdx::hmin(low), upper[axis] = stdx::hmax(high);
  }
  merged.box = {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
  merged.flux = stdx::reduce(load_aligned(node.flux));  // lanes without a child hold 0
  merged.capped_flux = stdx::reduce(load_aligned(node.capped_flux));
  merged.normals = merge_cones(node.axis, node.cosine, node.sine, children);
  if (tree.gloss.empty()) return merged;
  const GlossyLanes& gloss = tree.gloss[index];
  const LaneSelection glossy = load_aligned(gloss.peak) > 0;
  if (stdx::none_of(glossy)) return merged;
  for (int lane = 0; lane < count; ++lane)
    if (gloss.peak[lane] > 0) merged.gloss += {gloss.peak[lane], gloss.tail[lane], gloss.alpha2[lane]};
  merged.mirrored = merge_cones(gloss.axis, gloss.cosine, gloss.sine, glossy);
  return merged;
}

}  // namespace gradslc
