#include "core/parallel.h"
#include "integrators/gathering.h"
#include "integrators/record.h"
#include "integrators/registry.h"
#include "integrators/vpl_source.h"
#include "lighttree/estimated_cut.h"

namespace gradslc {
namespace {

/// What gathering has cost.
struct CutCost {
  std::uint64_t rays = 0, gathers = 0, clusters = 0, representatives = 0, shadow_rays = 0, node_evaluations = 0;
  CutCost& operator+=(const CutCost& o) {
    rays += o.rays, gathers += o.gathers, clusters += o.clusters, representatives += o.representatives;
    shadow_rays += o.shadow_rays, node_evaluations += o.node_evaluations;
    return *this;
  }
};

/// Lightcuts over virtual point lights (Walter et al. 2005): clusters are summed up by one representative each, in
/// cuts refined until every cluster's error bound is below a share of the total. Biased by these errors; what is not
/// light from VPLs is as in the other methods.
class Lightcuts final : public Integrator {
 public:
  void describe(ParameterVisitor& v) override {
    v.real("error_ratio", limits_.error_ratio, {0, 1}, "share",
           "the cut is fine enough once no cluster's error bound is above this share of the total estimate");
    v.integer("max_cut_size", limits_.most_clusters, {1, 1e6}, "clusters", "most clusters of a cut");
    source_.describe(v);
  }

  void prepare(const Scene& scene, const RenderSettings& settings) override {
    scene_ = &scene, settings_ = settings;
    source_.prepare(scene, settings);
    gather_ = make_gather_settings(scene, source_.parameters(), source_.bound(), settings.max_depth);
  }

  MemoryPlan plan_memory(const Scene& scene, const RenderSettings& settings) const override {
    return source_.plan_memory(scene, settings);
  }

  void render_pass(std::uint32_t pass, Film& film) override {
    const PassSlot slot = pass_slot(pass, static_cast<std::uint32_t>(source_.parameters().passes_per_set));
    const LoggedSamples logged = logged_samples(slot, film);
    const LightTree& tree = source_.vpls_of(slot);
    if (represented_set_ != source_.sets()) choose_representatives(slot, tree);
    const Resolution resolution = film.resolution();
    FilmHalf& half = film.half(slot.half);
    cost_ += parallel_sum<CutCost>(resolution.pixels(), 256, [&](std::size_t begin, std::size_t end) {
      CutCost cost;
      EstimatedCut cut;
      PathLog log;
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
          gather_cut(context, *prefix.gather, tree, cut, cost).collect(prefix.throughput, radiance);
        }
        record(half, pixel, radiance, context);
        cost.rays += context.rays;
      }
      return cost;
    });
    if (slot.closes_set) film.close_set(slot.half);
  }

  IntegratorTraits traits() const override {
    IntegratorTraits traits = source_.traits();
    traits.biased = true;
    return traits;
  }

  IntegratorStatistics statistics() const override {
    IntegratorStatistics statistics{.rays = cost_.rays + source_.rays(), .counters = {}};
    source_.append_counters(statistics.counters);
    const auto count = [&](const char* name, double value) { statistics.counters.push_back({name, value}); };
    const auto per_gather = [&](std::uint64_t value) {
      return cost_.gathers > 0 ? static_cast<double>(value) / static_cast<double>(cost_.gathers) : 0;
    };
    count("gathers", static_cast<double>(cost_.gathers));
    count("node_evaluations", static_cast<double>(cost_.node_evaluations));
    count("mean_cut_size", per_gather(cost_.clusters));
    count("representatives_per_gather", per_gather(cost_.representatives));
    count("shadow_rays_per_gather", per_gather(cost_.shadow_rays));
    return statistics;
  }

 private:
  /// Once for a set, whose half is 0 where it serves the whole run.
  void choose_representatives(const PassSlot& slot, const LightTree& tree) {
    const int half = source_.parameters().passes_per_set == 0 ? 0 : slot.half;
    representatives_ =
        Representatives(tree, hash_combine(derive_seed(settings_.seed, SeedPurpose::representatives, half), slot.set));
    represented_set_ = source_.sets();
  }

  /// Light from VPLs at x. A representative that the limit of depth leaves out brings 0 for its cluster, as often as
  /// such VPLs have their share of its flux: on average over representatives, a cluster's estimate is what counts of
  /// it. So are the parts.
  VplLight gather_cut(PathContext& context, const PathVertex& x, const LightTree& tree, EstimatedCut& cut,
                      CutCost& cost) const {
    const int nearest_vertex = source_.has_vpls_on_emitters() ? 0 : 1;
    if (x.edges + 1 + nearest_vertex > settings_.max_depth) return {};
    const GatherPoint point{x, context.lobes};
    const VplView vpls{context.scene.materials(), tree.set};
    const auto contribution_of = [&](std::uint32_t index) {
      const Vpl& vpl = vpls[index];
      if (!vpl_may_count(context, x, vpl)) return Rgb();
      const Rgb contribution = unshadowed_contribution(point, vpls, vpl, gather_.bound);
      if (is_black(contribution)) return Rgb();
      ++cost.shadow_rays;
      return contribution * connection_transmittance(context, connection_segment(point, vpl), connection_edges(x, vpl));
    };
    find_estimated_cut(tree, representatives_, make_receiver(point), gather_.bound, limits_, std::cref(contribution_of),
                       cut);
    ++cost.gathers;
    cost.clusters += cut.clusters.size(), cost.representatives += cut.representatives;
    cost.node_evaluations += cut.evaluated.size();
    if (context.log) log_cut(context, x, tree, cut);
    const auto on_emitter = [&](std::uint32_t vpl) { return vpls[vpl].vertex == 0; };
    return {.direct = cut.total(on_emitter), .vpl = cut.total(std::not_fn(on_emitter))};
  }

  /// Connections are told of when the cut is known: what a representative stands for changes while it is refined.
  void log_cut(const PathContext& context, const PathVertex& x, const LightTree& tree, const EstimatedCut& cut) const {
    context.log->add_selection(static_cast<float>(cut.clusters.size()), static_cast<float>(cut.evaluated.size()));
    const GatherPoint point{x, context.lobes};
    const VplView vpls{context.scene.materials(), tree.set};
    PathContext again = context;  // its rays have been counted
    for (const EstimatedCluster& cluster : cut.clusters) {
      const auto [index, flux] = cluster.representative;
      const Vpl& vpl = vpls[index];
      if (!vpl_may_count(context, x, vpl)) continue;
      const Rgb contribution = unshadowed_contribution(point, vpls, vpl, gather_.bound);
      if (is_black(contribution)) continue;
      log_connection(context, x, vpls, index, gather_.bound, contribution,
                     connection_transmittance(again, connection_segment(point, vpl), connection_edges(x, vpl)),
                     flux / luminance(vpl.flux));
    }
  }

  ErrorLimits limits_;
  VplSource source_{VplSource::Structure::tree};
  const Scene* scene_ = nullptr;
  RenderSettings settings_;
  GatherSettings gather_;
  Representatives representatives_;
  std::uint64_t represented_set_ = 0;  ///< VplSource::sets() when they were chosen
  CutCost cost_;
};

}  // namespace

std::unique_ptr<Integrator> make_lightcuts() { return std::make_unique<Lightcuts>(); }

}  // namespace gradslc
