#include <mutex>

#include "core/parallel.h"
#include "integrators/cut_gather.h"
#include "integrators/record.h"
#include "integrators/registry.h"
#include "integrators/vpl_source.h"
#include "shifts/block_partition.h"
#include "shifts/registry.h"
#include "shifts/stencil.h"

namespace gradslc {
namespace {

enum class Gather : std::uint8_t { descent };

/// What a pass has cost, base and offset pixels apart.
struct GradientCost {
  SelectionCost selection;
  std::uint64_t prefix_rays = 0, base_rays = 0, offset_rays = 0;
  GradientCost& operator+=(const GradientCost& o) {
    selection += o.selection;
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
    v.group("block", "random_replay: pixels that share random numbers", [&] {
      v.integer("width", block_.width, {1, 1024}, "pixels", "columns of a block");
      v.integer("height", block_.height, {1, 1024}, "pixels", "rows of a block");
    });
    v.choice("gather", gather_kind_, {"descent"},
             "how VPLs are selected: per pixel by descent from a cut (as published)");
    v.integer("cut_size", cut_size_, {1, 100000}, "nodes", "nodes of the cut, and so shadow rays of a gather");
    source_.describe(v);
  }

  void prepare(const Scene& scene, const RenderSettings& settings) override {
    scene_ = &scene, settings_ = settings;
    source_.prepare(scene, settings);
    gather_ = make_gather_settings(scene, source_.parameters(), source_.bound(), settings.max_depth);
  }

  void render_pass(std::uint32_t pass, Film& film) override {
    const PassSlot slot = pass_slot(pass, static_cast<std::uint32_t>(source_.parameters().passes_per_set));
    const LoggedSamples logged = logged_samples(slot, film);
    const LightTree& tree = source_.vpls_of(slot);
    FilmHalf& half = film.half(slot.half);
    trace_prefixes(slot, film.resolution(), logged);
    if (shift_ == Shift::reconnection)
      render_stencils(slot, tree, logged, half);
    else
      render_blocks(slot, tree, logged, half);
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
    count("node_evaluations", cost_.selection.node_evaluations);
    count("selections", cost_.selection.selections);
    count("prefix_rays", cost_.prefix_rays);
    count("base_rays", cost_.base_rays);
    count("offset_rays", cost_.offset_rays);
    return statistics;
  }

 private:
  // Streams of random numbers within a half: one for the whole image, one per group.
  static constexpr std::uint64_t k_image_stream = std::uint64_t{1} << 62;

  SampleStream stream(const PassSlot& slot, std::uint64_t id) const {
    return {settings_.sampler, derive_seed(settings_.seed, SeedPurpose::camera, slot.half), id, slot.sample};
  }
  PathContext context(const SampleStream& random) const {
    return {*scene_, settings_, source_.parameters().lobes(), random};
  }

  void trace_prefixes(const PassSlot& slot, Resolution resolution, const LoggedSamples& logged) {
    prefixes_ = Image<CameraPrefix>(resolution);
    if (logged.any()) prefix_logs_ = Image<PathLog>(resolution);
    const SampleStream random = stream(slot, k_image_stream);
    const Vec2 jitter = random.get2(Use::pixel);
    cost_.prefix_rays += parallel_sum<std::uint64_t>(resolution.pixels(), 256, [&](std::size_t begin, std::size_t end) {
      std::uint64_t rays = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const Pixel pixel = resolution.pixel(i);
        PathContext path = context(random);
        if (logged.any()) path.log = logged.begin_part(pixel, prefix_logs_[i]);
        prefixes_[i] = trace_camera_prefix(path, film_position(pixel, jitter));
        if (path.log) path.log->add_rays(path.rays);
        rays += path.rays;
      }
      return rays;
    });
  }

  Receiver receiver(Pixel pixel) const {
    return make_receiver({*prefixes_[pixel].gather, source_.parameters().lobes()});
  }

  /// The log of a pixel's sample, the camera's part of it told; null where none is wanted.
  PathLog* begin_log(const LoggedSamples& logged, Pixel pixel, PathLog& memory) const {
    PathLog* log = logged.begin(pixel, memory);
    if (log) log->append(prefix_logs_[pixel], 1);
    return log;
  }

  /// One pixel's sample with the random numbers and VPLs of a group.
  PartValues sample(const LightTree& tree, Pixel pixel, const SampleStream& random, std::span<const ChosenVpl> chosen,
                    std::uint64_t& rays, PathLog* log) const {
    const CameraPrefix& prefix = prefixes_[pixel];
    PartValues radiance = prefix.radiance;
    if (!prefix.gather) return radiance;
    PathContext path = context(random);
    path.log = log;
    gather_without_vpls(path, prefix, gather_, radiance);
    gather_chosen(path, *prefix.gather, tree, chosen, gather_.bound).collect(prefix.throughput, radiance);
    if (log) log->add_rays(path.rays);
    rays += path.rays;
    return radiance;
  }

  /// random_replay: every pixel of a block selects for itself with the block's random numbers; gradients inside blocks.
  void render_blocks(const PassSlot& slot, const LightTree& tree, const LoggedSamples& logged, FilmHalf& half) {
    const BlockPartition partition(prefixes_.resolution(), block_,
                                   stream(slot, k_image_stream).get2(Use::group_offset));
    run_groups(partition.size(), tree, [&](std::size_t group, CutSelector& selector, GradientCost& cost) {
      const auto [first, size] = partition.block(group);
      const SampleStream random = stream(slot, group);
      Image<PartValues> samples(size);
      PathLog memory;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const Pixel pixel = first + size.pixel(i);
        PathLog* const log = begin_log(logged, pixel, memory);
        std::span<const ChosenVpl> chosen;
        if (prefixes_[pixel].gather) {
          const Receiver alone = receiver(pixel);
          chosen = selector.select({&alone, 1}, random);
          log_selection(log, selector.last_cost());
        }
        samples[i] = sample(tree, pixel, random, chosen, cost.base_rays, log);
        record(half, pixel, samples[i], log);
      }
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const Pixel local = size.pixel(i), pixel = first + local;
        const Pixel right{local.x + 1, local.y}, lower{local.x, local.y + 1};
        if (size.contains(right)) half.dx.add(pixel, samples[right].total() - samples[i].total());
        if (size.contains(lower)) half.dy.add(pixel, samples[lower].total() - samples[i].total());
      }
    });
  }

  /// reconnection: a group is a base pixel with its offsets; one choice of VPLs by the law shared over all of them.
  /// Offsets' values are samples of their own pixels too.
  void render_stencils(const PassSlot& slot, const LightTree& tree, const LoggedSamples& logged, FilmHalf& half) {
    const Resolution resolution = prefixes_.resolution();
    const auto offsets = stencil_offsets(stencil_);
    stencil_values_.assign(resolution.pixels() * offsets.size(), PartValues());
    if (logged.any()) stencil_logs_.assign(stencil_values_.size(), PathLog());
    run_groups(resolution.pixels(), tree, [&](std::size_t group, CutSelector& selector, GradientCost& cost) {
      const Pixel base = resolution.pixel(group);
      const SampleStream random = stream(slot, group);
      std::array<Receiver, std::size(k_stencil_offsets)> receivers;
      std::size_t receiver_count = 0;
      for (const Pixel offset : offsets)
        if (resolution.contains(base + offset) && prefixes_[base + offset].gather)
          receivers[receiver_count++] = receiver(base + offset);
      std::span<const ChosenVpl> chosen;
      if (receiver_count > 0) chosen = selector.select(std::span(receivers).first(receiver_count), random);
      for (std::size_t k = 0; k < offsets.size(); ++k) {
        const Pixel pixel = base + offsets[k];
        if (!resolution.contains(pixel)) continue;
        PathLog* const log = logged.any() ? logged.begin_part(pixel, stencil_logs_[stencil_index(group, k)]) : nullptr;
        if (prefixes_[pixel].gather) log_selection(log, selector.last_cost(), receiver_count);
        stencil_value(group, k) =
            sample(tree, pixel, random, chosen, k == k_base ? cost.base_rays : cost.offset_rays, log);
      }
    });
    parallel_for(resolution.pixels(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) record_stencil_values(resolution.pixel(i), logged, half);
    });
  }

  std::size_t stencil_index(std::size_t base, std::size_t k) const {
    return base * stencil_offsets(stencil_).size() + k;
  }
  PartValues& stencil_value(std::size_t base, std::size_t k) { return stencil_values_[stencil_index(base, k)]; }

  /// The pixel's primal is the mean over all groups that hold it; a difference the mean over those that hold both
  /// pixels.
  void record_stencil_values(Pixel pixel, const LoggedSamples& logged, FilmHalf& half) {
    const Resolution resolution = prefixes_.resolution();
    const auto offsets = stencil_offsets(stencil_);
    PartValues sum;
    int count = 0;
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      const Pixel base{pixel.x - offsets[k].x, pixel.y - offsets[k].y};
      if (!resolution.contains(base)) continue;
      sum += stencil_value(resolution.index(base), k);
      ++count;
    }
    sum *= 1 / static_cast<float>(count);
    PathLog memory;
    PathLog* const log = begin_log(logged, pixel, memory);
    if (log) append_group_logs(pixel, count, *log);
    record(half, pixel, sum, log);

    const auto difference = [&](Pixel step, std::size_t forward, std::size_t backward, MomentImage& moments) {
      if (!resolution.contains(pixel + step)) return;
      const std::size_t here = resolution.index(pixel), there = resolution.index(pixel + step);
      Rgb d = stencil_value(here, forward).total() - stencil_value(here, k_base).total();
      if (stencil_ == Stencil::symmetric)
        d = 0.5f * (d + stencil_value(there, k_base).total() - stencil_value(there, backward).total());
      moments.add(pixel, d);
    };
    difference({1, 0}, k_right, k_left, half.dx);
    difference({0, 1}, k_lower, k_upper, half.dy);
  }

  void append_group_logs(Pixel pixel, int groups, PathLog& log) const {
    const Resolution resolution = prefixes_.resolution();
    const auto offsets = stencil_offsets(stencil_);
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      const Pixel base{pixel.x - offsets[k].x, pixel.y - offsets[k].y};
      if (!resolution.contains(base)) continue;
      log.note(happening::Group{base, groups});
      log.append(stencil_logs_[stencil_index(resolution.index(base), k)], 1 / static_cast<float>(groups));
    }
  }

  /// Runs body(group, selector, cost) for all groups in parallel.
  template <class Body>
  void run_groups(std::size_t groups, const LightTree& tree, const Body& body) {
    std::mutex cost_mutex;
    parallel_for(groups, 64, [&](std::size_t begin, std::size_t end) {
      CutSelector selector(tree, {.size = cut_size_}, gather_.bound);
      GradientCost cost;
      for (std::size_t group = begin; group < end; ++group) body(group, selector, cost);
      cost.selection = selector.cost();
      const std::lock_guard lock(cost_mutex);
      cost_ += cost;
    });
  }

  Shift shift_ = Shift::reconnection;
  Stencil stencil_ = Stencil::forward;
  Resolution block_{4, 4};
  Gather gather_kind_ = Gather::descent;
  int cut_size_ = 10;
  VplSource source_{VplSource::Structure::tree};
  const Scene* scene_ = nullptr;
  RenderSettings settings_;
  GatherSettings gather_;
  Image<CameraPrefix> prefixes_;
  std::vector<PartValues> stencil_values_;  // per base pixel and offset
  // The same where samples are logged: of prefixes_ and stencil_values_.
  Image<PathLog> prefix_logs_;
  std::vector<PathLog> stencil_logs_;
  GradientCost cost_;
};

}  // namespace

std::unique_ptr<Integrator> make_gradient_stochastic_lightcuts() {
  return std::make_unique<GradientStochasticLightcuts>();
}

}  // namespace gradslc
