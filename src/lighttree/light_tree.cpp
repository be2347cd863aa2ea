#include "lighttree/light_tree.h"

namespace gradslc {

void set_lane(LightNode& node, GlossyLanes* gloss, int lane, const LightCluster& cluster, std::uint32_t child) {
  for (int axis = 0; axis < 3; ++axis) {
    node.lower[axis][lane] = cluster.box.lower[axis];
    node.upper[axis][lane] = cluster.box.upper[axis];
    node.axis[axis][lane] = cluster.normals.axis[axis];
  }
  node.flux[lane] = cluster.flux, node.capped_flux[lane] = cluster.capped_flux;
  node.cosine[lane] = cluster.normals.cosine, node.sine[lane] = cluster.normals.sine();
  node.child[lane] = child;
  if (!gloss) return;
  gloss->peak[lane] = cluster.gloss.peak, gloss->tail[lane] = cluster.gloss.tail;
  gloss->alpha2[lane] = cluster.gloss.peak > 0 ? cluster.gloss.alpha2 : 1;
  for (int axis = 0; axis < 3; ++axis) gloss->axis[axis][lane] = cluster.mirrored.axis[axis];
  gloss->cosine[lane] = cluster.mirrored.cosine, gloss->sine[lane] = cluster.mirrored.sine();
}

void clear_lanes(LightNode& node, GlossyLanes* gloss, int lane) {
  LightCluster nothing;
  nothing.box = {Point3(), Point3()};
  for (; lane < LightNode::k_width; ++lane) set_lane(node, gloss, lane, nothing, LightNode::k_none);
}

LightCluster cluster_of_lane(const LightTree& tree, NodeIndex index, int lane) {
  const LightNode& node = tree.nodes[index];
  const auto vector = [&](const LightNode::Lanes(&v)[3]) { return Vec3{v[0][lane], v[1][lane], v[2][lane]}; };
  LightCluster cluster;
  cluster.box = {Point3() + vector(node.lower), Point3() + vector(node.upper)};
  cluster.flux = node.flux[lane], cluster.capped_flux = node.capped_flux[lane];
  cluster.normals = {vector(node.axis), node.cosine[lane]};
  if (tree.gloss.empty()) return cluster;
  const GlossyLanes& gloss = tree.gloss[index];
  cluster.gloss = {gloss.peak[lane], gloss.tail[lane], gloss.alpha2[lane]};
  cluster.mirrored = {vector(gloss.axis), gloss.cosine[lane]};
  return cluster;
}

}  // namespace gradslc
