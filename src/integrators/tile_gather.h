#pragma once

#include <span>
#include <vector>

#include "integrators/draw_scatter.h"
#include "integrators/gathering.h"
#include "lighttree/candidates.h"

namespace gradslc {

/// The two-level gathering of DESIGN 5.
struct TileParameters {
  int size = 16, candidates = 512, samples = 10;
  float defensive = 0.1f, cosine_floor = 0.2f, power_share = 0.4f;
  bool learn_visibility = true;
};

inline void describe(ParameterVisitor& v, TileParameters& p) {
  v.integer("size", p.size, {1, 256}, "pixels", "side of a tile, whose pixels share their candidates");
  v.integer("candidates", p.candidates, {1, 65536}, "VPLs", "VPLs drawn for a tile by its law");
  v.integer("samples", p.samples, {1, 65536}, "VPLs", "VPLs drawn for a pixel among the tile's, and so shadow rays");
  v.real("defensive", p.defensive, {0, 1e3}, "share",
         "weight of the importance to all of a tile's receivers beside that to representatives");
  v.real("cosine_floor", p.cosine_floor, {0, 1}, "cosine", "least cosine in the importance to representatives");
  v.real("power_share", p.power_share, {0, 1}, "share", "of the candidates, which are drawn by power instead");
  v.boolean("learn_visibility", p.learn_visibility,
            "candidates that a tile's earlier pixels could not see are drawn less often by the later ones");
}

/// Light from VPLs at a pixel of a tile, and how far it scatters.
struct TileLight {
  VplLight light;
  /// Of `light`'s luminance over choices among the candidates, for a single draw: estimated from how unlike successive
  /// draws are, which systematic sampling makes neighbours in the tree's order (Wolter 1984, estimator v2).
  float draw_variance = 0;
};

/// What gathering by tiles has cost.
struct TileCost {
  std::uint64_t nodes = 0, candidates = 0, evaluations = 0;  ///< evaluations of candidates
  TileCost& operator+=(const TileCost& o) {
    nodes += o.nodes, candidates += o.candidates, evaluations += o.evaluations;
    return *this;
  }
};

/// Gathers from VPLs at the points of one tile after the other. Keeps its memory between tiles; one per thread.
class TileGatherer {
 public:
  /// `lobes`: those that connect. `bound`: b. `reach`: how far from the tile's gather points gather_behind() is called;
  /// 0: never.
  TileGatherer(const Scene& scene, const LightTree& tree, const TileParameters& parameters, const LobeSelection& lobes,
               float bound, float reach)
      : vpls_{scene.materials(), tree.set},
        tree_(tree),
        parameters_(parameters),
        lobes_(lobes),
        bound_(bound),
        reach_(reach) {}

  /// Draws the candidates for all gather points of a tile, `u` in [0,1).
  void begin_tile(std::span<const Receiver> receivers, double u);
  /// Light from VPLs at x, which must be one of the tile's, by `draws` >= 1 of them; `u` in [0,1).
  TileLight gather(PathContext& context, const PathVertex& x, int draws, double u);
  /// The candidates, for choices that several gather points share. What earlier ones have seen is learned here, once
  /// for all of these: what one of them sees may not decide what the same random numbers draw for another.
  CandidateSet& share();
  /// Counts evaluations of all candidates for as many gather points.
  void count_evaluations(std::size_t receivers) { cost_.evaluations += receivers * candidates_.size(); }
  /// A VertexGather, of one draw, at a vertex behind a ray sent from one of the tile's gather points.
  Rgb gather_behind(PathContext& context, const PathVertex& y, const Compensation& left_over, int max_edges);
  const VplView& vpls() const { return vpls_; }
  const TileParameters& parameters() const { return parameters_; }
  const TileCost& cost() const { return cost_; }
  /// Nodes that were visited for the tile.
  std::uint64_t tile_nodes() const { return tile_nodes_; }

 private:
  void calibrate(std::span<const Receiver> receivers);
  /// Over the candidates that were evaluated last.
  TileLight sum_draws(PathContext& context, const PathVertex& x, const CandidateReceiver& receiver,
                      const Compensation* left_over, int max_edges, int samples, double u);

  VplView vpls_;
  const LightTree& tree_;
  const TileParameters& parameters_;
  LobeSelection lobes_;
  float bound_, reach_;
  std::vector<Candidate> drawn_;
  CandidateSet candidates_;
  std::vector<CandidateDraw> choice_;
  TileCost cost_;
  std::uint64_t tile_nodes_ = 0;
  static constexpr int k_gathers_between_lessons = 8;
  int gathers_ = 0;  ///< of this tile
};

}  // namespace gradslc
