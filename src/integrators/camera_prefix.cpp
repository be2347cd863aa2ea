#include "integrators/camera_prefix.h"

#include "core/constants.h"

namespace gradslc {
namespace {

/// Which kind of lobe is taken, in proportion to energy. `remapped`: the random number, to be used once more.
struct LobeChoice {
  bool connectable = false;
  float probability = 0;  ///< 0: nothing is reflected
  float remapped = 0;
};

LobeChoice choose_lobe(const PathVertex& vertex, const LobeSelection& lobes, float u) {
  const float connectable = vertex.bsdf.energy(vertex.wo, lobes.only_connectable());
  const float other = vertex.bsdf.energy(vertex.wo, lobes.only_other());
  if (connectable + other == 0) return {};
  const float p = connectable / (connectable + other);
  if (u < p) return {true, p, std::min(u / p, k_one_minus_epsilon)};
  return {false, 1 - p, std::min((u - p) / (1 - p), k_one_minus_epsilon)};
}

}  // namespace

CameraPrefix trace_camera_prefix(PathContext& context, Vec2 position) {
  CameraPrefix prefix;
  const PerspectiveCamera& camera = context.scene.camera();
  Ray ray =
      camera.has_lens() ? camera.generate_ray(position, context.random.get2(Use::lens)) : camera.generate_ray(position);
  RayOrigin origin{.position = ray.origin};
  auto throughput = LabelledThroughput::camera_path(Rgb(1));
  const int max_edges = context.settings.max_depth;
  int edges = 0;
  while (const auto hit = next_hit(context, ray, origin, edges, max_edges, throughput, prefix.radiance)) {
    const PathVertex vertex = make_path_vertex(context.scene, *hit, -ray.direction, edges);
    if (context.log) log_vertex(context, vertex, throughput.total());
    if (passes_on(context, vertex, throughput, ray, origin)) continue;
    const auto index = static_cast<std::uint32_t>(edges);
    const LobeChoice choice = choose_lobe(vertex, context.lobes, context.random.get1(Use::lobe, index));
    if (context.features.image) show_surface(context, vertex, choice.connectable);
    if (choice.probability == 0) break;
    throughput = throughput.scaled(1 / choice.probability);
    if (choice.connectable) {
      prefix.gather = vertex;
      prefix.throughput = throughput.prefix;
      break;
    }

    const LobeSelection others = context.lobes.only_other();
    add_next_event(context, vertex, others, max_edges, throughput, nullptr, prefix.radiance);
    const auto sample =
        vertex.bsdf.sample(vertex.wo, choice.remapped, context.random.get2(Use::direction, index), others);
    if (!sample) break;
    throughput = throughput.scattered({Rgb(), sample->weight});
    if (throughput.is_black()) break;
    ray = spawn_ray(vertex.point, vertex.to_world(sample->direction));
    origin = {vertex.point.position, sample->pdf_solid_angle, sample->delta};
  }
  context.features = {};
  return prefix;
}

}  // namespace gradslc
