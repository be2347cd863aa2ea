#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "film/debug_image.h"
#include "integrators/part_values.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "scene/surface.h"

namespace gradslc {

/// What can happen on the paths of a sample. `edges`: of the path up to where it happens.
namespace happening {

/// The path comes to a surface. Its energies are what lobes are chosen by (Bsdf::energy()).
struct Vertex {
  int edges;
  Point3 position;
  Normal3 shading_normal;  ///< on the path's side
  std::uint32_t material;
  float connectable_energy, other_energy;
  float pass_probability;  ///< of going straight on instead of being scattered
  Rgb throughput;          ///< of the path up to here
};
/// It passes straight through the surface that it has come to.
struct Crossing {};
/// It gathers at the vertex that it has come to: a VPL's light is multiplied by `throughput`, the camera path's over
/// the probability of the lobes that it took.
struct Gather {
  Rgb throughput;
};
/// A ray through f_c(x) begins, the `index`-th from 0; what it brings is multiplied by `scale`, one over the mean
/// number of such rays. What follows up to the next one or to CompensationEnd is on its path.
struct CompensationRay {
  std::uint32_t index;
  float scale;
};
/// The rays through f_c(x) are done.
struct CompensationEnd {};
/// It hits an emitter, or leaves the scene towards one.
struct EmitterHit {
  int edges;
  std::optional<Point3> position;  ///< nullopt: at infinity
  Rgb radiance;
  float mis_weight;  ///< by luminance: environments are weighted one by one
};
/// Next-event estimation from the last vertex, whose shadow ray was traced.
struct NextEvent {
  int edges;  ///< with the connection
  Vec3 direction;
  std::optional<Point3> position;  ///< nullopt: at infinity
  Rgb radiance;
  float pdf_solid_angle;  ///< for delta emitters the discrete probability
  bool delta;
  float mis_weight;
  Rgb transmittance;
};
/// Connection with a VPL whose shadow ray was traced.
struct VplConnection {
  std::uint32_t vpl;  ///< index into the set
  int vertex;         ///< k: which of its light path
  int edges;          ///< D, crossings left out
  Point3 position;
  std::optional<std::uint32_t> material;  ///< of y, where f_c(y) is not Lambert's
  float distance;
  Rgb unshadowed;  ///< as bounded, without the weight
  Rgb transmittance;
  float bounded_weight;                   ///< min(1, b/K)
  float weight;                           ///< over the expected number of its draws, times the actual one
  std::optional<float> candidate_weight;  ///< share of `weight` that comes from its being a tile's candidate
};
/// A group of pixels begins whose samples share the choice of VPLs; the pixel's sample is the mean over `groups`.
struct Group {
  Pixel base;
  int groups;
};

}  // namespace happening
using Happening = std::variant<happening::Vertex, happening::Crossing, happening::Gather, happening::CompensationRay,
                               happening::CompensationEnd, happening::EmitterHit, happening::NextEvent,
                               happening::VplConnection, happening::Group>;

/// One sample of one pixel as the path code tells it: what it cost, its largest contribution and, where asked for, all
/// that happened. Contributions sum to the sample's value, but for rounding.
class PathLog {
 public:
  struct Entry {
    Happening what;
    Rgb value;                 ///< that it added to the sample
    std::optional<Part> part;  ///< the one with the most of it; nullopt: nothing, or parts are not told apart
  };

  void start(std::uint32_t pass, bool keeps_entries);

  /// Notes what brings no light of its own.
  void note(const Happening& what);
  void begin_gather(Rgb throughput);
  /// Next-event estimation at the vertex that gathers begins, one of several estimates: each times `scale`.
  void begin_next_events(float scale);
  void begin_compensation_ray(std::uint32_t index, float scale);
  /// Within such a ray: it gathers at the vertex that it has come to.
  void begin_vertex_gather(Rgb throughput);
  void end_compensation_rays();
  /// Light met by the path; `brought` as it is added to the path's radiance. `by_parts`: its parts are told apart.
  void add(const Happening& what, const PartValues& brought, bool by_parts);
  /// Light from a VPL, as it leaves x.
  void add_vpl(const happening::VplConnection& connection);
  /// What choosing VPLs has cost.
  void add_selection(float cut_size, float node_evaluations);
  void add_rays(std::uint64_t rays) { sample_.rays += rays; }
  void add_failed_shift() { ++sample_.failed_shifts; }
  /// All of another log, its light and cut size times `scale`.
  void append(const PathLog& other, float scale);
  /// Ends the sample, whose value is what the film gets.
  void finish(Rgb value) { sample_.value = value; }

  const DebugSample& sample() const { return sample_; }
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  void add_entry(const Happening& what, Rgb value, std::optional<Part> part);

  DebugSample sample_;
  bool keeps_entries_ = false;
  Rgb gather_throughput_{1};
  std::optional<Rgb> vertex_throughput_;  ///< while a compensation ray gathers
  float scale_ = 1;                       ///< of next-event estimates or rays at the vertex that gathers
  std::vector<Entry> entries_;
};

/// Asks for the log of one sample.
struct Probe {
  Pixel pixel;
  std::uint32_t pass = 0;
  PathLog* log = nullptr;  ///< null: nothing is asked for
};

/// Which samples of a pass are logged: all of them where a film keeps debug images, else the one that is probed.
class LoggedSamples {
 public:
  LoggedSamples(bool debug, const Probe& probe, std::uint32_t pass)
      : debug_(debug), pass_(pass), probe_(probe.pass == pass ? probe : Probe()) {}

  bool any() const { return debug_ || probe_.log; }
  /// Whether the probe makes these pixels superfluous.
  bool skips(Pixel pixel) const { return skips(pixel, {1, 1}); }
  bool skips(Pixel first, Resolution size) const {
    return probe_.log && !debug_ && !size.contains({probe_.pixel.x - first.x, probe_.pixel.y - first.y});
  }
  /// The log for a pixel's sample, begun; null where none is wanted. `memory` is used unless it is the probe's.
  PathLog* begin(Pixel pixel, PathLog& memory) const {
    if (!logs(pixel)) return nullptr;
    return begun(pixel, is_probed(pixel) ? *probe_.log : memory);
  }
  /// The same for a part of the sample, to be appended to its log; always in `memory`.
  PathLog* begin_part(Pixel pixel, PathLog& memory) const { return logs(pixel) ? begun(pixel, memory) : nullptr; }

 private:
  bool is_probed(Pixel pixel) const { return probe_.log && pixel == probe_.pixel; }
  bool logs(Pixel pixel) const { return debug_ || is_probed(pixel); }
  PathLog* begun(Pixel pixel, PathLog& log) const {
    log.start(pass_, is_probed(pixel));
    return &log;
  }

  bool debug_;
  std::uint32_t pass_;
  Probe probe_;
};

}  // namespace gradslc
