#include <mutex>

#include "core/parallel.h"
#include "integrators/cut_gather.h"
#include "integrators/gather_effort.h"
#include "integrators/record.h"
#include "integrators/registry.h"
#include "integrators/tile_gather.h"
#include "integrators/vpl_source.h"
#include "shifts/block_partition.h"

namespace gradslc {
namespace {

enum class Gather : std::uint8_t { descent, tile };

/// Stochastic lightcuts over virtual point lights, with bounded and compensated connections: as published (Yuksel
/// 2019), or with candidates shared by the pixels of a tile (DESIGN 5).
class StochasticLightcuts final : public Integrator {
 public:
  void describe(ParameterVisitor& v) override {
    v.choice("gather", gather_kind_, {"descent", "tile"},
             "how VPLs are selected: per pixel by descent from a cut (as published), or among a tile's candidates");
    v.integer("cut_size", cut_limits_.size, {1, 100000}, "nodes",
              "descent: most nodes of the cut, and so shadow rays of a gather");
    v.real(
        "cut_error", cut_limits_.error, {0, 1}, "share",
        "descent: the cut is fine enough once no bound that could be refined is above this share of all; 0: cut_size");
    v.group("tile", "tile: candidates shared by the pixels of a tile", [&] { gradslc::describe(v, tile_); });
    v.group("effort", "tile: how many samples of each kind a gather takes", [&] { effort_.describe(v); });
    v.boolean("gather_vertices", gather_vertices_,
              "tile: vertices behind the rays that bring what bounding takes gather from the tile's candidates; false: "
              "paths go on from there");
    source_.describe(v);
  }

  void prepare(const Scene& scene, const RenderSettings& settings) override {
    scene_ = &scene, settings_ = settings;
    effort_.reset();
    source_.prepare(scene, settings);
    gather_ = make_gather_settings(scene, source_.parameters(), source_.bound(), settings.max_depth);
    reach_ = gather_vertices_ ? reach_of_vertices(scene, gather_, settings.max_depth) : 0;
  }

  void render_pass(std::uint32_t pass, Film& film) override {
    const PassSlot slot = pass_slot(pass, static_cast<std::uint32_t>(source_.parameters().passes_per_set));
    if (gather_kind_ == Gather::descent)
      render_pixels(slot, source_.vpls_of(slot), film);
    else
      effort_.render_pass(
          pass, film, tile_.samples,
          [this](std::uint32_t number, const EffortPlan& plan, Film& target) { render_tiles(number, plan, target); });
    if (slot.closes_set) film.close_set(slot.half);
  }

  MemoryPlan plan_memory(const Scene& scene, const RenderSettings& settings) const override {
    return source_.plan_memory(scene, settings);
  }
  IntegratorTraits traits() const override { return source_.traits(); }
  IntegratorStatistics statistics() const override {
    IntegratorStatistics statistics{.rays = rays_ + source_.rays(), .counters = {}};
    source_.append_counters(statistics.counters);
    const auto count = [&](const char* name, std::uint64_t value) {
      statistics.counters.push_back({name, static_cast<double>(value)});
    };
    count("node_evaluations", cut_cost_.node_evaluations + tile_cost_.nodes);
    if (gather_kind_ == Gather::descent) {
      count("selections", cut_cost_.selections);
      count("cut_nodes", cut_cost_.cut_nodes);
    } else {
      count("candidates", tile_cost_.candidates);
      count("candidate_evaluations", tile_cost_.evaluations);
    }
    return statistics;
  }

 private:
  void render_pixels(const PassSlot& slot, const LightTree& tree, Film& film) {
    const Resolution resolution = film.resolution();
    const LoggedSamples logged = logged_samples(slot, film);
    FilmHalf& half = film.half(slot.half);
    std::mutex cost_mutex;
    parallel_for(resolution.pixels(), 256, [&](std::size_t begin, std::size_t end) {
      CutSelector selector(tree, cut_limits_, gather_.bound);
      PathLog log;
      std::uint64_t rays = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const Pixel pixel = resolution.pixel(i);
        if (logged.skips(pixel)) continue;
        auto [context, position] = make_pixel_sample(*scene_, settings_, source_.parameters().lobes(), slot, i);
        context.log = logged.begin(pixel, log);
        context.features = half.feature_sink(pixel);
        const CameraPrefix prefix = trace_camera_prefix(context, position);
        PartValues radiance = prefix.radiance;
        if (prefix.gather) {
          gather_without_vpls(context, prefix, gather_, radiance);
          const Receiver receiver = make_receiver({*prefix.gather, context.lobes});
          const auto chosen = selector.select({&receiver, 1}, context.random);
          log_selection(context.log, selector.last_cost());
          gather_chosen(context, *prefix.gather, tree, chosen, gather_.bound).collect(prefix.throughput, radiance);
        }
        record(half, pixel, radiance, context);
        rays += context.rays;
      }
      const std::lock_guard lock(cost_mutex);
      rays_ += rays, cut_cost_ += selector.cost();
    });
  }

  /// Tiles lie at an offset drawn anew for each pass, so that their borders move.
  void render_tiles(std::uint32_t pass, const EffortPlan& plan, Film& film) {
    const PassSlot slot = pass_slot(pass, static_cast<std::uint32_t>(source_.parameters().passes_per_set));
    const LightTree& tree = source_.vpls_of(slot);
    const std::uint64_t seed = derive_seed(settings_.seed, SeedPurpose::tiles, slot.half);
    const auto tile_stream = [&](std::uint64_t tile) {
      return SampleStream(settings_.sampler, seed, tile, slot.sample);
    };
    constexpr std::uint64_t k_image = ~std::uint64_t{0};
    const BlockPartition partition(film.resolution(), {tile_.size, tile_.size},
                                   tile_stream(k_image).get2(Use::group_offset));
    const LoggedSamples logged = logged_samples(slot, film);
    FilmHalf& half = film.half(slot.half);
    std::mutex cost_mutex;
    constexpr std::size_t k_tiles_per_chunk = 4;  // memory is kept from tile to tile
    parallel_for(partition.size(), k_tiles_per_chunk, [&](std::size_t begin, std::size_t end) {
      TileGatherer gatherer(*scene_, tree, tile_, source_.parameters().lobes(), gather_.bound, reach_);
      VertexGather behind;
      if (reach_ > 0) behind = [&gatherer](auto&&... at) { return gatherer.gather_behind(at...); };
      std::vector<TilePixel> pixels;
      std::vector<Receiver> receivers;
      std::vector<PathLog> logs;
      std::uint64_t rays = 0;
      for (std::size_t tile = begin; tile < end; ++tile) {
        const auto [first, size] = partition.block(tile);
        if (logged.skips(first, size)) continue;
        pixels.clear(), receivers.clear();
        if (logged.any()) logs.resize(size.pixels());
        for (std::size_t i = 0; i < size.pixels(); ++i) {
          const Pixel pixel = first + size.pixel(i);
          auto [context, position] = make_pixel_sample(*scene_, settings_, source_.parameters().lobes(), slot,
                                                       film.resolution().index(pixel), plan.camera);
          if (logged.any()) context.log = logged.begin(pixel, logs[i]);
          context.features = half.feature_sink(pixel);
          const auto& prefix = pixels.emplace_back(context, trace_camera_prefix(context, position)).prefix;
          if (prefix.gather) receivers.push_back(make_receiver({*prefix.gather, context.lobes}));
        }
        gatherer.begin_tile(receivers, tile_stream(tile).get1_double(Use::tile_comb));
        const float node_share = static_cast<float>(gatherer.tile_nodes()) / static_cast<float>(size.pixels());
        for (std::size_t i = 0; i < size.pixels(); ++i) {
          auto& [context, prefix] = pixels[i];
          const Pixel pixel = first + size.pixel(i);
          PartValues radiance = prefix.radiance;
          EffortAllocation::Sample seen;
          if (prefix.gather) {
            const GatherEffort effort = plan.effort(pixel);
            seen = gather_without_vpls(context, prefix, gather_, radiance, effort, behind);
            const double u = context.random.get1_double(Use::candidate_choice);
            const auto [light, draw_variance] = gatherer.gather(context, *prefix.gather, effort.draws, u);
            light.collect(prefix.throughput, radiance);
            seen.draw_variance = draw_variance * luminance(prefix.throughput) * luminance(prefix.throughput);
          }
          seen.total = luminance(radiance.total());
          plan.note(pixel, seen);
          if (context.log) context.log->add_selection(0, node_share);
          record(half, pixel, radiance, context);
          rays += context.rays;
        }
      }
      const std::lock_guard lock(cost_mutex);
      rays_ += rays, tile_cost_ += gatherer.cost();
    });
  }

  struct TilePixel {
    PathContext context;
    CameraPrefix prefix;
  };

  Gather gather_kind_ = Gather::descent;
  CutLimits cut_limits_{.size = 10};
  TileParameters tile_;
  AdaptedEffort effort_;
  bool gather_vertices_ = true;
  VplSource source_{VplSource::Structure::tree};
  const Scene* scene_ = nullptr;
  RenderSettings settings_;
  GatherSettings gather_;
  float reach_ = 0;  ///< of vertices that gather from candidates
  SelectionCost cut_cost_;
  TileCost tile_cost_;
  std::uint64_t rays_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_stochastic_lightcuts() { return std::make_unique<StochasticLightcuts>(); }

}  // namespace gradslc
