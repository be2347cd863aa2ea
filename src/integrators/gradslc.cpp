#include <mutex>

#include "core/parallel.h"
#include "integrators/gradient_record.h"
#include "integrators/group_gather.h"
#include "integrators/prefix_region.h"
#include "integrators/record.h"
#include "integrators/registry.h"
#include "integrators/vpl_source.h"
#include "shifts/block_partition.h"
#include "shifts/registry.h"
#include "shifts/stencil.h"

namespace gradslc {
namespace {

enum class Gather : std::uint8_t { descent, tile };

/// What a pass has cost, base and offset pixels apart.
struct GradientCost {
  SelectionCost selection;
  TileCost tile;
  std::uint64_t prefix_rays = 0, base_rays = 0, offset_rays = 0;
  GradientCost& operator+=(const GradientCost& o) {
    selection += o.selection, tile += o.tile;
    prefix_rays += o.prefix_rays, base_rays += o.base_rays, offset_rays += o.offset_rays;
    return *this;
  }
};

/// Gradient-domain stochastic lightcuts (DESIGN 6). All pixels of a pass share the random numbers of the camera's part
/// of the path; a group of pixels shares those of the light's part, so that the shift between its pixels is the
/// identity in primary sample space: its Jacobian is 1 and it cannot fail. Groups are independent of each other.
class GradientStochasticLightcuts final : public Integrator {
 public:
  void describe(ParameterVisitor& v) override {
    v.choice("shift", shift_, shift_names(), "how neighbours' samples are made alike");
    v.choice("stencil", stencil_, {"forward", "symmetric"}, "reconnection: neighbours of a base pixel");
    v.group("block", "pixels that share random numbers: block, and random_replay by descent", [&] {
      v.integer("width", block_.width, {1, 1024}, "pixels", "columns of a block");
      v.integer("height", block_.height, {1, 1024}, "pixels", "rows of a block");
      v.boolean("share_rays", share_rays_,
                "false: a block's pixels share the choice of VPLs alone; their rays through f_c(x) and next-event "
                "estimates are independent, whose noise is then no blotch of a block's size, but in gradients, too");
    });
    v.choice("gather", gather_kind_, {"descent", "tile"},
             "how VPLs are selected: by descent from a cut (as published), or among a tile's candidates");
    v.integer("cut_size", cut_size_, {1, 100000}, "nodes", "descent: nodes of the cut, and so shadow rays of a gather");
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
    groups_ = {.gather = make_gather_settings(scene, source_.parameters(), source_.bound(), settings.max_depth),
               .lobes = source_.parameters().lobes(),
               .cut = {.size = cut_size_}};
    if (gather_kind_ == Gather::descent) return;
    groups_.tile = tile_;
    // Visibility is learned from draws that are independent of later ones': not where a tile repeats its own.
    if (shift_ == Shift::random_replay) groups_.tile->learn_visibility = false;
    if (gather_vertices_) groups_.reach = reach_of_vertices(scene, groups_.gather, settings.max_depth);
  }

  void render_pass(std::uint32_t pass, Film& film) override {
    if (gather_kind_ == Gather::descent)
      render_tiles(pass, {}, film);
    else
      effort_.render_pass(
          pass, film, tile_.samples,
          [this](std::uint32_t number, const EffortPlan& plan, Film& target) { render_tiles(number, plan, target); });
    const PassSlot slot = slot_of(pass);
    if (slot.closes_set) film.close_set(slot.half);
  }

  MemoryPlan plan_memory(const Scene& scene, const RenderSettings& settings) const override {
    return source_.plan_memory(scene, settings);
  }
  IntegratorTraits traits() const override {
    IntegratorTraits traits = source_.traits();
    traits.gradients = true;
    return traits;
  }

  IntegratorStatistics statistics() const override {
    IntegratorStatistics statistics{.rays = source_.rays() + cost_.prefix_rays + cost_.base_rays + cost_.offset_rays,
                                    .counters = {}};
    source_.append_counters(statistics.counters);
    const auto count = [&](const char* name, std::uint64_t value) {
      statistics.counters.push_back({name, static_cast<double>(value)});
    };
    count("node_evaluations", cost_.selection.node_evaluations + cost_.tile.nodes);
    if (gather_kind_ == Gather::descent) {
      count("selections", cost_.selection.selections);
    } else {
      count("candidates", cost_.tile.candidates);
      count("candidate_evaluations", cost_.tile.evaluations);
    }
    count("prefix_rays", cost_.prefix_rays);
    count("base_rays", cost_.base_rays);
    count("offset_rays", cost_.offset_rays);
    return statistics;
  }

 private:
  using Block = BlockPartition::Block;

  /// What a thread needs for its tiles.
  struct Worker {
    GroupGatherer gatherer;
    PrefixRegion region;
    std::vector<Receiver> receivers;
    std::vector<GroupSample> samples;
    std::vector<PathLog> logs;
    GradientCost cost;
  };
  /// What all tiles of a pass share.
  struct PassView {
    const PassSlot& slot;
    const EffortPlan& plan;
    const LoggedSamples& logged;
    const BlockPartition& tiles;
    FilmHalf& half;
    bool gradients;
  };

  PassSlot slot_of(std::uint32_t pass) const {
    return pass_slot(pass, static_cast<std::uint32_t>(source_.parameters().passes_per_set));
  }
  // Streams of random numbers within a half: one for the whole image, one for each group, named by a pixel of its own.
  static constexpr std::uint64_t k_image_stream = std::uint64_t{1} << 62;
  SampleStream stream(const PassSlot& slot, SeedPurpose purpose, std::uint64_t id) const {
    return {settings_.sampler, derive_seed(settings_.seed, purpose, slot.half), id, slot.sample};
  }
  PathContext context(const SampleStream& random) const { return {*scene_, settings_, groups_.lobes, random}; }
  std::uint64_t index(Pixel pixel) const { return scene_->camera().resolution().index(pixel); }

  /// Where tiles and groups begin stays for some passes of a half: then a pixel's samples in these are one aligned run
  /// of one group's sequence, and stratified.
  Vec2 group_offset(const PassSlot& slot, SeedPurpose purpose) const {
    constexpr std::uint32_t k_passes_per_offset = 4;
    PassSlot run = slot;
    run.sample /= k_passes_per_offset;
    return stream(run, purpose, k_image_stream).get2(Use::group_offset);
  }
  /// Groups lie within tiles, whose borders move.
  Resolution tile_size() const {
    if (shift_ == Shift::reconnection || (shift_ == Shift::random_replay && groups_.tile))
      return {tile_.size, tile_.size};
    const auto whole_blocks = [&](int side) { return (tile_.size + side - 1) / side * side; };
    return {whole_blocks(block_.width), whole_blocks(block_.height)};
  }

  void render_tiles(std::uint32_t pass, const EffortPlan& plan, Film& film) {
    const PassSlot slot = slot_of(pass);
    const LightTree& tree = source_.vpls_of(slot);
    const LoggedSamples logged = logged_samples(slot, film);
    const BlockPartition tiles(film.resolution(), tile_size(), group_offset(slot, plan.camera));
    const PassView view{slot, plan, logged, tiles, film.half(slot.half), film.layers().gradients};
    if (shift_ == Shift::reconnection) stencils_.begin(film.resolution(), stencil_, logged.any());
    std::mutex cost_mutex;
    constexpr std::size_t k_tiles_per_chunk = 4;  // memory is kept from tile to tile
    parallel_for(tiles.size(), k_tiles_per_chunk, [&](std::size_t begin, std::size_t end) {
      Worker worker{.gatherer{*scene_, tree, groups_}, .region{}, .receivers{}, .samples{}, .logs{}, .cost{}};
      for (std::size_t tile = begin; tile < end; ++tile) render_tile(view, tile, worker);
      worker.cost.selection = worker.gatherer.cut_cost(), worker.cost.tile = worker.gatherer.tile_cost();
      const std::lock_guard lock(cost_mutex);
      cost_ += worker.cost;
    });
    if (shift_ == Shift::reconnection) stencils_.record(logged, view.half, view.gradients);
  }

  void render_tile(const PassView& view, std::size_t number, Worker& worker) const {
    const Block tile = view.tiles.block(number);
    const Block region = shift_ == Shift::reconnection ? with_neighbours(tile) : tile;
    if (view.logged.skips(region.first, region.size)) return;
    const SampleStream image_stream = stream(view.slot, view.plan.camera, k_image_stream);
    // A pixel shows its features in its own tile.
    const auto sink = [&](Pixel pixel) {
      const bool own = tile.size.contains({pixel.x - tile.first.x, pixel.y - tile.first.y});
      return own ? view.half.feature_sink(pixel) : FeatureSink();
    };
    worker.region.trace(
        context(image_stream), image_stream.get2(Use::pixel), region.first, region.size, view.logged,
        [&](Pixel pixel) { return !is_corner(pixel, tile); }, sink);
    worker.cost.prefix_rays += worker.region.rays();
    worker.receivers.clear();
    for (const CameraPrefix& prefix : worker.region.prefixes())
      if (prefix.gather) worker.receivers.push_back(make_receiver({*prefix.gather, groups_.lobes}));
    worker.gatherer.begin_tile(worker.receivers,
                               stream(view.slot, SeedPurpose::tiles, number).get1_double(Use::tile_comb));
    if (shift_ == Shift::reconnection) return gather_stencils(view, tile, worker);
    if (shift_ == Shift::random_replay && groups_.tile) return gather_group(view, tile, tile, worker);
    view.tiles.for_each_within(tile, block_, [&](const Block& block) { gather_group(view, tile, block, worker); });
  }

  /// The tile and the offsets just outside it.
  Block with_neighbours(const Block& tile) const {
    const Resolution image = scene_->camera().resolution();
    const int before = stencil_ == Stencil::symmetric ? 1 : 0;
    const Pixel first{std::max(tile.first.x - before, 0), std::max(tile.first.y - before, 0)};
    const Pixel end{std::min(tile.first.x + tile.size.width + 1, image.width),
                    std::min(tile.first.y + tile.size.height + 1, image.height)};
    return {first, {end.x - first.x, end.y - first.y}};
  }

  /// Of the neighbours, those that no pixel of the tile shifts to.
  static bool is_corner(Pixel pixel, const Block& tile) {
    const Pixel local{pixel.x - tile.first.x, pixel.y - tile.first.y};
    return (local.x < 0 || local.x >= tile.size.width) && (local.y < 0 || local.y >= tile.size.height);
  }

  GroupSample begin_sample(const Worker& worker, Pixel pixel, const SampleStream& random, PathLog* log) const {
    const CameraPrefix& prefix = worker.region[pixel];
    GroupSample sample{context(random), &prefix, prefix.radiance, {}};
    sample.context.log = log;
    return sample;
  }
  float node_share(const Worker& worker, const Block& tile) const {
    return static_cast<float>(worker.gatherer.tile_nodes()) / static_cast<float>(tile.size.pixels());
  }

  /// block, random_replay: the pixels of a rectangle, with the same random numbers. Differences lie within it.
  void gather_group(const PassView& view, const Block& tile, const Block& group, Worker& worker) const {
    const auto [first, size] = group;
    const SampleStream random = stream(view.slot, view.plan.camera, index(first));
    const GatherEffort effort = view.plan.effort(first);
    std::vector<GroupSample>& samples = worker.samples;
    samples.clear();
    if (view.logged.any()) worker.logs.resize(std::max(worker.logs.size(), size.pixels()));
    for (std::size_t i = 0; i < size.pixels(); ++i) {
      const Pixel pixel = first + size.pixel(i);
      PathLog* const log = view.logged.any() ? view.logged.begin(pixel, worker.logs[i]) : nullptr;
      if (log) log->append(worker.region.log(pixel), 1), log->add_selection(0, node_share(worker, tile));
      samples.push_back(begin_sample(worker, pixel, random, log));
      if (shift_ == Shift::block && !share_rays_)
        samples.back().context.random = random.branch(static_cast<std::uint32_t>(i));
    }
    if (shift_ == Shift::block)
      worker.gatherer.gather_together(samples, effort, random);
    else
      for (GroupSample& sample : samples) worker.gatherer.gather_alone(sample, effort);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      GroupSample& sample = samples[i];
      const Pixel pixel = first + size.pixel(i);
      worker.cost.base_rays += sample.context.rays;
      note(view, pixel, sample);
      record(view.half, pixel, sample.radiance, sample.context);
    }
    if (!view.gradients) return;
    record_differences(group, view.half, [&](std::size_t i) { return samples[i].radiance.total(); });
  }

  void note(const PassView& view, Pixel pixel, GroupSample& sample) const {
    sample.seen.total = luminance(sample.radiance.total());
    view.plan.note(pixel, sample.seen);
  }

  /// reconnection: a group is a base pixel with its offsets; one choice of VPLs by the law shared over all of them.
  void gather_stencils(const PassView& view, const Block& tile, Worker& worker) const {
    for (std::size_t i = 0; i < tile.size.pixels(); ++i) {
      const Pixel base = tile.first + tile.size.pixel(i);
      const SampleStream random = stream(view.slot, view.plan.camera, index(base));
      worker.samples.clear();
      std::array<std::size_t, std::size(k_stencil_offsets)> places;
      for (std::size_t k = 0; k < stencil_offsets(stencil_).size(); ++k) {
        const Pixel pixel = base + k_stencil_offsets[k];
        if (!worker.region.contains(pixel)) continue;
        PathLog* const log = stencils_.begin_log(view.logged, base, k);
        // A pixel's own tile tells what its prefix has met; here only what it has cost to trace it once more.
        const bool outside = !tile.size.contains({pixel.x - tile.first.x, pixel.y - tile.first.y});
        if (log && outside) log->add_rays(worker.region.log(pixel).sample().rays);
        places[worker.samples.size()] = k;
        worker.samples.push_back(begin_sample(worker, pixel, random, log));
      }
      if (PathLog* const log = stencils_.begin_prefix_log(view.logged, base)) {
        log->append(worker.region.log(base), 1);
        log->add_selection(0, node_share(worker, tile));
      }
      worker.gatherer.gather_together(worker.samples, view.plan.effort(base), random);
      for (std::size_t j = 0; j < worker.samples.size(); ++j) {
        GroupSample& sample = worker.samples[j];
        (places[j] == k_base ? worker.cost.base_rays : worker.cost.offset_rays) += sample.context.rays;
        if (sample.context.log) sample.context.log->add_rays(sample.context.rays);
        stencils_.value(base, places[j]) = sample.radiance;
        if (places[j] == k_base) note(view, base, sample);
      }
    }
  }

  Shift shift_ = Shift::reconnection;
  Stencil stencil_ = Stencil::forward;
  Resolution block_{4, 4};
  bool share_rays_ = true;
  Gather gather_kind_ = Gather::descent;
  int cut_size_ = 10;
  TileParameters tile_;
  AdaptedEffort effort_;
  bool gather_vertices_ = true;
  VplSource source_{VplSource::Structure::tree};
  const Scene* scene_ = nullptr;
  RenderSettings settings_;
  GroupGatherSettings groups_;
  mutable StencilValues stencils_;  // each base's by the thread of its tile
  GradientCost cost_;
};

}  // namespace

std::unique_ptr<Integrator> make_gradient_stochastic_lightcuts() {
  return std::make_unique<GradientStochasticLightcuts>();
}

}  // namespace gradslc
