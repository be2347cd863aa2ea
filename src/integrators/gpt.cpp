#include <algorithm>
#include <array>
#include <string>

#include "core/parallel.h"
#include "integrators/gradient_path.h"
#include "integrators/record.h"
#include "integrators/registry.h"
#include "shifts/registry.h"
#include "shifts/stencil.h"

namespace gradslc {
namespace {

/// The neighbours that a pixel's path is shifted to.
constexpr std::size_t k_neighbours = std::size(k_stencil_offsets) - 1;
constexpr Pixel neighbour_offset(std::size_t k) { return k_stencil_offsets[k + 1]; }
constexpr std::size_t k_to_right = k_right - 1, k_to_lower = k_lower - 1, k_to_left = k_left - 1,
                      k_to_upper = k_upper - 1;

/// What passes have cost, base and offset paths apart, and what became of the shifts.
struct ShiftCost {
  std::uint64_t base_rays = 0, offset_rays = 0, shifts = 0;
  std::array<std::uint64_t, k_shift_failure_count> failures = {};

  void count(const OffsetPath& offset) {
    ++shifts;
    if (offset.failure()) ++failures[static_cast<std::size_t>(*offset.failure())];
  }
  ShiftCost& operator+=(const ShiftCost& o) {
    base_rays += o.base_rays, offset_rays += o.offset_rays, shifts += o.shifts;
    for (std::size_t i = 0; i < failures.size(); ++i) failures[i] += o.failures[i];
    return *this;
  }
};

/// Gradient-domain path tracing (Kettunen et al. 2015): the path of each pixel, which is path tracing's, is shifted
/// through the four neighbours, and both senses of a shift between two pixels give their difference.
class GradientPathTracer final : public Integrator {
 public:
  void describe(ParameterVisitor& v) override {
    v.choice("shift", shift_, {"reconnection", "random_replay"},
             "how offset paths are made: reconnected to the base path, or traced with its random numbers");
    v.real("shift_roughness", shift_roughness_, {1e-3, 1}, "alpha",
           "reconnection: lobes this rough and rougher are reconnected, half vectors of sharper ones are copied");
    v.boolean("shift_emission", shift_emission_,
              "reconnection: emitters seen by the camera are shifted, too, and not left to the primal");
    v.real("connectable_roughness", connectable_roughness_, {1e-3, 1}, "alpha",
           "threshold by which parts are labelled (as vpl.connectable_roughness)");
  }

  void prepare(const Scene& scene, const RenderSettings& settings) override { scene_ = &scene, settings_ = settings; }

  void render_pass(std::uint32_t pass, Film& film) override {
    const PassSlot slot = pass_slot(pass, 1);
    const LoggedSamples logged = logged_samples(slot, film);
    const Resolution resolution = film.resolution();
    FilmHalf& half = film.half(slot.half);
    const FilmLayers layers = film.layers();
    if (layers.gradients && differences_.resolution() != resolution) differences_ = Image<Differences>(resolution);
    cost_ += parallel_sum<ShiftCost>(resolution.pixels(), 256, [&](std::size_t begin, std::size_t end) {
      ShiftCost cost;
      PathLog log;
      for (std::size_t i = begin; i < end; ++i) {
        const Pixel pixel = resolution.pixel(i);
        if (logged.skips(pixel)) continue;
        auto [context, position] = make_pixel_sample(*scene_, settings_, {true, true, connectable_roughness_}, slot, i);
        context.log = logged.begin(pixel, log);
        context.features = half.feature_sink(pixel);
        Differences* const differences = layers.gradients ? &differences_[i] : nullptr;
        const PartValues radiance = layers.parts
                                        ? sample<LabelledThroughput>(context, position, pixel, differences, cost)
                                        : sample<PlainThroughput>(context, position, pixel, differences, cost);
        record(half, pixel, radiance, context);
        cost.base_rays += context.rays;
      }
      return cost;
    });
    if (layers.gradients) record_differences(logged, half);
    film.close_set(slot.half);
  }

  IntegratorTraits traits() const override { return {.gradients = true}; }

  IntegratorStatistics statistics() const override {
    IntegratorStatistics statistics{.rays = cost_.base_rays + cost_.offset_rays, .counters = {}};
    const auto count = [&](const std::string& name, std::uint64_t value) {
      statistics.counters.push_back({name, static_cast<double>(value)});
    };
    count("base_rays", cost_.base_rays);
    count("offset_rays", cost_.offset_rays);
    count("shifts", cost_.shifts);
    for (std::size_t i = 0; i < k_shift_failure_count; ++i)
      count(std::string("failed_shifts_") + k_shift_failure_names[i], cost_.failures[i]);
    return statistics;
  }

 private:
  using Differences = std::array<Rgb, k_neighbours>;  ///< weighted, neighbour minus pixel

  Ray camera_ray(const PathContext& context, Vec2 position) const {
    const PerspectiveCamera& camera = scene_->camera();
    return camera.has_lens() ? camera.generate_ray(position, context.random.get2(Use::lens))
                             : camera.generate_ray(position);
  }

  /// A pixel's own sample, and its differences to the neighbours in the image where asked for.
  template <class Throughput>
  PartValues sample(PathContext& context, Vec2 position, Pixel pixel, Differences* differences, ShiftCost& cost) const {
    std::array<std::size_t, k_neighbours> neighbours;
    std::size_t count = 0;
    if (differences)
      for (std::size_t k = 0; k < k_neighbours; ++k)
        if (scene_->camera().resolution().contains(pixel + neighbour_offset(k))) neighbours[count++] = k;
    const auto film_position_of = [&](std::size_t k) { return film_position(neighbour_offset(k), position); };

    PathContext offset_context = context;
    offset_context.log = nullptr, offset_context.features = {};
    PartValues radiance;
    if (shift_ == Shift::reconnection) {
      std::array<OffsetPath, k_neighbours> offsets;
      for (std::size_t j = 0; j < count; ++j) offsets[j].start(camera_ray(context, film_position_of(neighbours[j])));
      const GradientPathContext paths{context, offset_context, {true, true, shift_roughness_}, shift_emission_};
      trace_gradient_path<Throughput>(paths, camera_ray(context, position), std::span(offsets).first(count), radiance);
      for (std::size_t j = 0; j < count; ++j) {
        (*differences)[neighbours[j]] = offsets[j].difference();
        cost.count(offsets[j]);
        if (context.log && offsets[j].failure()) context.log->add_failed_shift();
      }
    } else {
      radiance = trace<Throughput>(context, position);
      for (std::size_t j = 0; j < count; ++j) {
        const PartValues offset = trace<PlainThroughput>(offset_context, film_position_of(neighbours[j]));
        (*differences)[neighbours[j]] = 0.5f * (offset.total() - radiance.total());
      }
      cost.shifts += count;
    }
    cost.offset_rays += offset_context.rays;
    if (context.log) context.log->add_rays(offset_context.rays);
    return radiance;
  }

  template <class Throughput>
  PartValues trace(PathContext& context, Vec2 position) const {
    const Ray ray = camera_ray(context, position);
    PartValues radiance;
    trace_path(context, ray, {.position = ray.origin}, Throughput(), 0, settings_.max_depth, 0, radiance);
    return radiance;
  }

  /// The difference of a pair of pixels is what both paths find, each shifted to the other's pixel.
  void record_differences(const LoggedSamples& logged, FilmHalf& half) const {
    const Resolution resolution = differences_.resolution();
    parallel_for(resolution.pixels(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Pixel pixel = resolution.pixel(i);
        const auto add = [&](std::size_t forward, std::size_t backward, MomentImage& moments) {
          const Pixel other = pixel + neighbour_offset(forward);
          if (!resolution.contains(other) || logged.skips(pixel) || logged.skips(other)) return;
          moments.add(pixel, differences_[i][forward] - differences_[other][backward]);
        };
        add(k_to_right, k_to_left, half.dx);
        add(k_to_lower, k_to_upper, half.dy);
      }
    });
  }

  Shift shift_ = Shift::reconnection;
  float shift_roughness_ = 0.05f;
  bool shift_emission_ = false;
  float connectable_roughness_ = 0.1f;
  const Scene* scene_ = nullptr;
  RenderSettings settings_;
  Image<Differences> differences_;  // of the pass that is being rendered
  ShiftCost cost_;
};

}  // namespace

std::unique_ptr<Integrator> make_gradient_path_tracer() { return std::make_unique<GradientPathTracer>(); }

}  // namespace gradslc
