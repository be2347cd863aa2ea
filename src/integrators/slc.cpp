#include <mutex>

#include "core/parallel.h"
#include "integrators/cut_gather.h"
#include "integrators/record.h"
#include "integrators/registry.h"
#include "integrators/vpl_source.h"

namespace gradslc {
namespace {

enum class Gather : std::uint8_t { descent };

/// Stochastic lightcuts (Yuksel 2019) over virtual point lights, with bounded and compensated connections.
class StochasticLightcuts final : public Integrator {
 public:
  void describe(ParameterVisitor& v) override {
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
    const LightTree& tree = source_.vpls_of(slot);
    const Resolution resolution = film.resolution();
    FilmHalf& half = film.half(slot.half);
    std::mutex cost_mutex;
    parallel_for(resolution.pixels(), 256, [&](std::size_t begin, std::size_t end) {
      CutSelector selector(tree, cut_size_, gather_.bound);
      std::uint64_t rays = 0;
      for (std::size_t i = begin; i < end; ++i) {
        record(half, resolution.pixel(i), sample(slot, tree, selector, i, rays));
      }
      const std::lock_guard lock(cost_mutex);
      rays_ += rays, cost_ += selector.cost();
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
    statistics.counters.push_back({"node_evaluations", static_cast<double>(cost_.node_evaluations)});
    statistics.counters.push_back({"selections", static_cast<double>(cost_.selections)});
    return statistics;
  }

 private:
  PartValues sample(const PassSlot& slot, const LightTree& tree, CutSelector& selector, std::size_t index,
                    std::uint64_t& rays) const {
    auto [context, position] = make_pixel_sample(*scene_, settings_, source_.parameters().lobes(), slot, index);
    const CameraPrefix prefix = trace_camera_prefix(context, position);
    PartValues radiance = prefix.radiance;
    if (prefix.gather) {
      gather_without_vpls(context, prefix, gather_, radiance);
      const Receiver receiver = make_receiver({*prefix.gather, context.lobes});
      const auto chosen = selector.select({&receiver, 1}, context.random);
      radiance[Part::vpl] += prefix.throughput * gather_chosen(context, *prefix.gather, tree, chosen, gather_.bound);
    }
    rays += context.rays;
    return radiance;
  }

  Gather gather_kind_ = Gather::descent;
  int cut_size_ = 10;
  VplSource source_{VplSource::Structure::tree};
  const Scene* scene_ = nullptr;
  RenderSettings settings_;
  GatherSettings gather_;
  SelectionCost cost_;
  std::uint64_t rays_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_stochastic_lightcuts() { return std::make_unique<StochasticLightcuts>(); }

}  // namespace gradslc
