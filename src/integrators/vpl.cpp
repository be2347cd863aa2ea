#include <span>

#include "core/distribution.h"
#include "core/parallel.h"
#include "integrators/gathering.h"
#include "integrators/record.h"
#include "integrators/registry.h"
#include "integrators/vpl_source.h"

namespace gradslc {
namespace {

enum class Selection : std::uint8_t { all, uniform, power };

/// Gathers from every VPL (instant radiosity, Keller 1997), or from a random sample of them: the oracle of the light
/// tree, and the baseline of its selection.
class VplSampler final : public Integrator {
 public:
  void describe(ParameterVisitor& v) override {
    v.choice("selection", selection_, {"all", "uniform", "power"}, "which VPLs a pixel gathers from");
    v.integer("samples", samples_, {1, 1e6}, "VPLs", "VPLs drawn per pixel, with replacement; not for \"all\"");
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
    const VplSet& set = source_.vpls_of(slot).set;
    if (selection_ == Selection::power) {
      std::vector<double> weights;
      weights.reserve(set.vpls.size());
      for (const Vpl& vpl : set.vpls) weights.push_back(static_cast<double>(luminance(vpl.flux)));
      by_power_ = DiscreteDistribution(weights);
    }
    const Resolution resolution = film.resolution();
    FilmHalf& half = film.half(slot.half);
    rays_ += parallel_sum<std::uint64_t>(resolution.pixels(), 64, [&](std::size_t begin, std::size_t end) {
      std::uint64_t rays = 0;
      PathLog log;
      for (std::size_t i = begin; i < end; ++i) {
        const Pixel pixel = resolution.pixel(i);
        if (logged.skips(pixel)) continue;
        auto [context, position] = make_pixel_sample(*scene_, settings_, source_.parameters().lobes(), slot, i);
        context.log = logged.begin(pixel, log);
        context.features = half.feature_sink(pixel);
        record(half, pixel, sample(context, position, set), context);
        rays += context.rays;
      }
      return rays;
    });
    if (slot.closes_set) film.close_set(slot.half);
  }

  MemoryPlan plan_memory(const Scene& scene, const RenderSettings& settings) const override {
    return source_.plan_memory(scene, settings);
  }
  IntegratorTraits traits() const override { return source_.traits(); }
  IntegratorStatistics statistics() const override {
    IntegratorStatistics statistics{.rays = rays_ + source_.rays(), .counters = {}};
    source_.append_counters(statistics.counters);
    return statistics;
  }

 private:
  PartValues sample(PathContext& context, Vec2 position, const VplSet& set) const {
    const CameraPrefix prefix = trace_camera_prefix(context, position);
    PartValues radiance = prefix.radiance;
    if (prefix.gather) {
      gather_without_vpls(context, prefix, gather_, radiance);
      gather_vpls(context, *prefix.gather, set).collect(prefix.throughput, radiance);
    }
    return radiance;
  }

  VplLight gather_vpls(PathContext& context, const PathVertex& x, const VplSet& set) const {
    VplLight light;
    const std::span<const Vpl> vpls = set.vpls;
    if (vpls.empty()) return light;
    if (selection_ == Selection::all) {
      if (context.log) context.log->add_selection(static_cast<float>(vpls.size()), 0);
      for (std::size_t i = 0; i < vpls.size(); ++i) light.from(vpls[i]) += connect(context, x, set, i, 1);
      return light;
    }
    if (selection_ == Selection::power && by_power_.total() == 0) return light;
    if (context.log) context.log->add_selection(static_cast<float>(samples_), 0);
    for (int s = 0; s < samples_; ++s) {
      const double u = context.random.get1_double(Use::vpl_choice, static_cast<std::uint32_t>(s));
      std::size_t chosen = static_cast<std::size_t>(u * static_cast<double>(vpls.size()));
      double probability = 1 / static_cast<double>(vpls.size());
      if (selection_ == Selection::power) {
        const auto drawn = by_power_.sample(u);
        chosen = drawn.index, probability = drawn.probability;
      }
      light.from(vpls[chosen]) += connect(context, x, set, chosen, static_cast<float>(1 / (probability * samples_)));
    }
    return light;
  }

  Rgb connect(PathContext& context, const PathVertex& x, const VplSet& set, std::size_t index, float weight) const {
    const Vpl& vpl = set.vpls[index];
    if (!vpl_may_count(context, x, vpl)) return Rgb();
    const GatherPoint point{x, context.lobes};
    const VplView view{context.scene.materials(), set};
    const Rgb contribution = unshadowed_contribution(point, view, vpl, gather_.bound);
    if (is_black(contribution)) return Rgb();
    const Rgb transmittance =
        connection_transmittance(context, connection_segment(point, vpl), connection_edges(x, vpl));
    if (context.log)
      log_connection(context, x, view, static_cast<std::uint32_t>(index), gather_.bound, contribution, transmittance,
                     weight);
    return contribution * transmittance * weight;
  }

  Selection selection_ = Selection::all;
  int samples_ = 10;
  VplSource source_{VplSource::Structure::list};
  const Scene* scene_ = nullptr;
  RenderSettings settings_;
  GatherSettings gather_;
  DiscreteDistribution by_power_;
  std::uint64_t rays_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_vpl_sampler() { return std::make_unique<VplSampler>(); }

}  // namespace gradslc
