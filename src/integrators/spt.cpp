#include "core/parallel.h"
#include "integrators/path.h"
#include "integrators/record.h"
#include "integrators/registry.h"

namespace gradslc {
namespace {

/// Simple path tracing: next-event estimation and BSDF sampling, combined by multiple importance sampling.
class PathTracer final : public Integrator {
 public:
  void describe(ParameterVisitor& v) override {
    v.integer("roulette_depth", roulette_depth_, {0, 1e6}, "edges",
              "paths of this many edges and more end by Russian roulette; 0: never");
    v.real("connectable_roughness", connectable_roughness_, {1e-3, 1}, "alpha",
           "threshold by which parts are labelled (as vpl.connectable_roughness)");
  }

  void prepare(const Scene& scene, const RenderSettings& settings) override { scene_ = &scene, settings_ = settings; }

  void render_pass(std::uint32_t pass, Film& film) override {
    const PassSlot slot = pass_slot(pass, 1);
    const LoggedSamples logged = logged_samples(slot, film);
    const bool labelled = film.layers().parts;
    const Resolution resolution = film.resolution();
    FilmHalf& half = film.half(slot.half);
    rays_ += parallel_sum<std::uint64_t>(resolution.pixels(), 256, [&](std::size_t begin, std::size_t end) {
      std::uint64_t rays = 0;
      PathLog log;
      for (std::size_t i = begin; i < end; ++i) {
        const Pixel pixel = resolution.pixel(i);
        if (logged.skips(pixel)) continue;
        auto [context, position] = make_pixel_sample(*scene_, settings_, {true, true, connectable_roughness_}, slot, i);
        context.log = logged.begin(pixel, log);
        context.features = half.feature_sink(pixel);
        const PartValues radiance =
            labelled ? sample<LabelledThroughput>(context, position) : sample<PlainThroughput>(context, position);
        record(half, pixel, radiance, context);
        rays += context.rays;
      }
      return rays;
    });
    film.close_set(slot.half);
  }

  IntegratorTraits traits() const override { return {}; }
  IntegratorStatistics statistics() const override { return {.rays = rays_, .counters = {}}; }

 private:
  template <class Throughput>
  PartValues sample(PathContext& context, Vec2 position) const {
    const PerspectiveCamera& camera = scene_->camera();
    const Ray ray = camera.has_lens() ? camera.generate_ray(position, context.random.get2(Use::lens))
                                      : camera.generate_ray(position);
    PartValues radiance;
    trace_path(context, ray, {.position = ray.origin}, Throughput(), 0, settings_.max_depth, roulette_depth_, radiance);
    return radiance;
  }

  int roulette_depth_ = 0;
  float connectable_roughness_ = 0.1f;
  const Scene* scene_ = nullptr;
  RenderSettings settings_;
  std::uint64_t rays_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_path_tracer() { return std::make_unique<PathTracer>(); }

}  // namespace gradslc
