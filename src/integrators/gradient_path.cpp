#include "integrators/gradient_path.h"

namespace gradslc {
namespace {

/// A step of trace_gradient_path() each.
template <class Throughput>
class GradientPath {
 public:
  GradientPath(const GradientPathContext& context, const Ray& camera_ray, std::span<OffsetPath> offsets,
               PartValues& radiance)
      : context_(context), base_(context.base), offsets_(offsets), radiance_(radiance), ray_(camera_ray) {
    origin_ = {.position = camera_ray.origin};
  }

  void trace() {
    while (edges_ < max_edges() && take_edge()) {
      const PathVertex& vertex = *vertex_;
      if (base_.log) log_vertex(base_, vertex, throughput_.total());
      if (pass(vertex)) continue;
      show(base_, vertex);
      add_next_event(vertex);
      if (!scatter(vertex)) return;
    }
  }

 private:
  int max_edges() const { return base_.settings.max_depth; }

  /// Traces the next edges of all paths and adds what emitters bring. False where the base path ends.
  bool take_edge() {
    std::optional<SurfacePoint> end;
    Rgb emission;
    const auto emission_of = [&](const std::optional<SurfacePoint>& hit) {
      end = hit;
      return emission = hit ? emitted_radiance(base_, *hit, -ray_.direction, origin_)
                            : environment_radiance(base_, ray_.direction, origin_);
    };
    const Throughput throughput = throughput_;
    const auto hit = trace_edge(base_, ray_, emission_of, edges_, max_edges(), throughput, radiance_);
    const bool counts = base_.settings.components.includes(edges_);
    if (!hit && !counts) return false;

    vertex_.reset();
    BaseEdge edge{departure_, ray_, counts ? end : hit, nullptr, edges_, !is_black(emission)};
    if (hit) {
      vertex_.emplace();
      base_.scene.shade(*hit, -ray_.direction, *vertex_);
      vertex_->edges = edges_;
      edge.vertex = &*vertex_;
      edge.emits = !is_black(base_.scene.emitters().radiance(*hit, -ray_.direction));
    }
    for (OffsetPath& offset : offsets_) {
      offset.follow(context_.offsets, context_.lobes, edge);
      if (edges_ == 1 && !context_.shifts_seen_emission)
        offset.add_unshifted(throughput.total() * emission);
      else if (counts)
        offset.add(throughput.total() * emission, offset.emission(context_.offsets, edge, emission));
      if (hit) offset.arrive();
    }
    return hit.has_value();
  }

  /// Draws whether the base path passes straight through its vertex.
  bool pass(const PathVertex& vertex) {
    if (!base_.scene.has_crossings()) return false;
    const float probability = vertex.bsdf.pass_probability(vertex.wo);
    const bool passes = passes_on(base_, vertex, throughput_, ray_, origin_);
    for (OffsetPath& offset : offsets_) offset.pass_or_scatter(vertex, passes, probability);
    if (passes) departure_ = Departure();
    return passes;
  }

  void add_next_event(const PathVertex& vertex) {
    if (!connection_may_count(base_, vertex.edges + 1, max_edges())) return;
    const auto light = choose_emitter(base_, vertex);
    NextEvent event;
    if (light) event = next_event(vertex, *light);
    for (OffsetPath& offset : offsets_) {
      Rgb value;
      switch (offset.state()) {
        case OffsetPath::State::separate:
          value = offset.next_event(context_.offsets);
          break;
        case OffsetPath::State::arriving:
          if (light) value = arriving_next_event(offset, vertex, *light, event);
          break;
        case OffsetPath::State::leaving:
        case OffsetPath::State::merged:
          value = offset.throughput() * event.weight;
          break;
        case OffsetPath::State::failed:
          break;
      }
      offset.add(event.brought, value);
    }
  }

  /// What next-event estimation brings the base path.
  struct NextEvent {
    Rgb weight;                      // radiance over density, without the path's throughput
    Rgb brought;                     // with it
    std::optional<Passage> passage;  // of the shadow ray, where it has been traced
  };

  NextEvent next_event(const PathVertex& vertex, const DirectSample& light) {
    NextEvent event;
    const Vec3 wi = vertex.to_local(light.wi);
    const float pdf = light.pdf_solid_angle;
    const LobeWeights weights = lobe_weights(vertex, wi, pdf, base_.lobes, nullptr);
    const Throughput scattered = throughput_.scattered(weights);
    if (scattered.is_black()) return event;
    event.passage = trace_shadow_ray(vertex, light);
    const Passage& passage = *event.passage;
    float mis = 0;
    PartValues brought;
    if (!is_black(passage.transmittance)) {
      mis = light.delta
                ? 1
                : power_heuristic(pdf, vertex.bsdf.pdf_solid_angle(vertex.wo, wi, base_.lobes) * passage.probability);
      brought = brought_through(scattered.transmitted(passage.transmittance).scaled(mis), light.radiance);
      event.weight = weights.total() * passage.transmittance * light.radiance * mis;
    }
    if (base_.log) log_next_event(base_, vertex, light, passage, mis, brought, Throughput::k_by_lobes);
    event.brought = brought.total();
    radiance_ += brought;
    return event;
  }

  /// The offset sees the base's emitter through the base's shadow ray.
  Rgb arriving_next_event(const OffsetPath& offset, const PathVertex& vertex, const DirectSample& light,
                          NextEvent& event) {
    const Vec3 wi = vertex.to_local(light.wi);
    const Rgb weight = offset.arriving_weight(vertex, wi, light);
    if (is_black(weight)) return Rgb();
    if (!event.passage) event.passage = trace_shadow_ray(vertex, light);
    const Passage& passage = *event.passage;
    if (is_black(passage.transmittance)) return Rgb();
    return weight * passage.transmittance * light.radiance * offset.arriving_mis(vertex, wi, light, passage);
  }

  Passage trace_shadow_ray(const PathVertex& vertex, const DirectSample& light) {
    return connect(base_, shadow_ray(vertex.point, light), vertex.edges + 1, max_edges());
  }

  /// Scatters the base path as scatter() of path.h does. False: it ends.
  bool scatter(const PathVertex& vertex) {
    const auto index = static_cast<std::uint32_t>(vertex.edges);
    const float u_lobe = vertex.bsdf.chooses_lobes() ? base_.random.get1(Use::lobe, index) : 0;
    const auto sample = vertex.bsdf.sample(vertex.wo, u_lobe, base_.random.get2(Use::direction, index), base_.lobes);
    if (!sample) return false;
    throughput_ = throughput_.scattered(Throughput::k_by_lobes ? lobe_weights(vertex, *sample, base_.lobes, nullptr)
                                                               : LobeWeights{sample->weight, Rgb()});
    if (throughput_.is_black()) return false;

    bool separate = false;
    for (OffsetPath& offset : offsets_) {
      offset.leave(vertex, *sample);
      separate = separate || offset.state() == OffsetPath::State::separate;
    }
    if (separate)
      departure_ = make_departure(vertex, *sample, context_.lobes, base_.random.get1(Use::lobe_kind, index));
    ray_ = spawn_ray(vertex.point, vertex.to_world(sample->direction));
    origin_ = {vertex.point.position, sample->pdf_solid_angle, sample->delta};
    return true;
  }

  const GradientPathContext& context_;
  PathContext& base_;
  std::span<OffsetPath> offsets_;
  PartValues& radiance_;
  Ray ray_;
  RayOrigin origin_;
  Throughput throughput_;
  int edges_ = 0;
  Departure departure_;
  std::optional<PathVertex> vertex_;
};

}  // namespace

template <class Throughput>
void trace_gradient_path(const GradientPathContext& context, const Ray& camera_ray, std::span<OffsetPath> offsets,
                         PartValues& radiance) {
  GradientPath<Throughput>(context, camera_ray, offsets, radiance).trace();
}

template void trace_gradient_path<PlainThroughput>(const GradientPathContext&, const Ray&, std::span<OffsetPath>,
                                                   PartValues&);
template void trace_gradient_path<LabelledThroughput>(const GradientPathContext&, const Ray&, std::span<OffsetPath>,
                                                      PartValues&);

}  // namespace gradslc
