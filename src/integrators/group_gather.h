#pragma once

#include <optional>
#include <span>
#include <vector>

#include "integrators/cut_gather.h"
#include "integrators/tile_gather.h"

namespace gradslc {

/// A pixel's sample in a group of pixels, whose random numbers are the group's (DESIGN 6).
struct GroupSample {
  PathContext context;
  const CameraPrefix* prefix;
  PartValues radiance;            ///< the prefix's, to begin with
  EffortAllocation::Sample seen;  ///< but for `total`
};

/// How a group's pixels gather.
struct GroupGatherSettings {
  GatherSettings gather;
  LobeSelection lobes;
  CutLimits cut;                       ///< of the gather `descent`
  std::optional<TileParameters> tile;  ///< of the gather `tile`; nullopt: descent
  float reach = 0;                     ///< of vertices that gather from the tile's candidates
};

/// Gathers at the points of one group of pixels after the other: with VPLs that the group has chosen together, or each
/// pixel for itself. Keeps its memory between groups; one per thread.
class GroupGatherer {
 public:
  GroupGatherer(const Scene& scene, const LightTree& tree, const GroupGatherSettings& settings);
  GroupGatherer(const GroupGatherer&) = delete;
  GroupGatherer& operator=(const GroupGatherer&) = delete;

  /// The gather `tile`: draws the candidates of all groups of a tile, `u` in [0,1). `descent` needs none.
  void begin_tile(std::span<const Receiver> receivers, double u);
  /// All samples gather from the same VPLs, chosen by `random` and the law shared over them: the sum of theirs, so that
  /// no pixel is short of a VPL that lights it. Each tests its own visibility.
  void gather_together(std::span<GroupSample> samples, const GatherEffort& effort, const SampleStream& random);
  /// The sample gathers from VPLs of its own choice.
  void gather_alone(GroupSample& sample, const GatherEffort& effort);

  const SelectionCost& cut_cost() const { return selector_.cost(); }
  TileCost tile_cost() const { return tile_ ? tile_->cost() : TileCost(); }
  /// Nodes that were visited for the tile.
  std::uint64_t tile_nodes() const { return tile_ ? tile_->tile_nodes() : 0; }

 private:
  struct Member {
    GroupSample* sample;
    CandidateReceiver receiver;
    VplLight light;
    DrawScatter scatter;
    const PathVertex& x() const { return *sample->prefix->gather; }
  };
  /// A VPL that the group gathers from.
  struct Draw {
    std::uint32_t vpl;
    float weight;                            ///< what a contribution is multiplied by
    std::uint32_t count = 1;                 ///< how often it was drawn
    std::optional<std::uint32_t> candidate;  ///< contributions hold its weight, then
  };
  struct Connection {
    std::size_t member;
    Rgb unshadowed;
    int edges;
  };

  void gather_without_vpls(GroupSample& sample, const GatherEffort& effort);
  /// Members that choose together.
  using Members = std::span<Member>;
  void choose_by_descent(Members members, const SampleStream& random);
  void choose_candidates(Members members, int samples, const SampleStream& random);
  /// Moves those of the members that are alike to the front and returns how many: the others would make their law worse
  /// and choose for themselves. What decides is where the paths have come to, not what lights them.
  static std::size_t gather_alike(Members members);
  /// Receivers whose targets sum up to the members' law: they or, where they lie in a plane, four corners of a
  /// rectangle around them. A VPL that lights a point of a plane lights one of any corners around it.
  void find_law_receivers(Members members);
  static bool are_flat(Members members);
  /// Connects all members that it may light with one VPL; their shadow rays are one packet.
  void connect(Members members, const Draw& draw);
  Rgb unshadowed(const Member& member, const Draw& draw) const;

  const Scene& scene_;
  const LightTree& tree_;
  GroupGatherSettings settings_;
  VplView vpls_;
  CutSelector selector_;
  std::optional<TileGatherer> tile_;
  VertexGather behind_;
  CandidateSet* candidates_ = nullptr;
  std::vector<Member> members_;
  std::vector<CandidateReceiver> law_receivers_;
  std::vector<Receiver> receivers_;
  std::vector<CandidateDraw> choice_;
  std::vector<Draw> draws_;
  // Of one draw.
  std::vector<Connection> connections_;
  std::vector<Ray> segments_;
  std::vector<int> max_crossings_;
  std::vector<Passage> passages_;
};

}  // namespace gradslc
