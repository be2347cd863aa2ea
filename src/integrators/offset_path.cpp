#include "integrators/offset_path.h"

#include "shifts/half_vector.h"
#include "shifts/reconnection.h"

namespace gradslc {
namespace {

constexpr LobeSelection k_all_lobes;

LobeSelection of_kind(Departure::Kind kind, const LobeSelection& lobes) {
  return kind == Departure::Kind::connectable ? lobes.only_connectable() : lobes.only_other();
}

struct KindCount {
  int connectable = 0, other = 0;  // delta lobes in neither
};
KindCount count_kinds(const Bsdf& bsdf, const LobeSelection& lobes) {
  KindCount count;
  for (const Bsdf::Entry& entry : bsdf.entries())
    if (entry.roughness != k_delta_roughness)
      ++(lobes.is_connectable(entry.roughness) ? count.connectable : count.other);
  return count;
}

/// Density with which a direction is sampled through lobes of one kind, 1/sr; `pdf`: through all.
float pdf_of_kind(const PathVertex& vertex, const Vec3& wi, float pdf, Departure::Kind kind,
                  const LobeSelection& lobes) {
  if (!(pdf > 0)) return 0;
  const KindCount count = count_kinds(vertex.bsdf, lobes);
  const bool connectable = kind == Departure::Kind::connectable;
  if ((connectable ? count.connectable : count.other) == 0) return 0;
  if ((connectable ? count.other : count.connectable) == 0) return pdf;
  const LobeSelection selected = of_kind(kind, lobes);
  return vertex.bsdf.pdf_solid_angle(vertex.wo, wi, selected) * vertex.bsdf.energy(vertex.wo, selected) /
         vertex.bsdf.energy(vertex.wo, k_all_lobes);
}

/// Index below the surface over that above, of the first lobe that refracts; nullopt: none does.
std::optional<float> refractive_index(const Bsdf& bsdf) {
  for (const Bsdf::Entry& entry : bsdf.entries())
    if (const auto* lobe = std::get_if<RoughDielectric>(&entry.lobe)) return lobe->eta;
  return std::nullopt;
}

/// Whether offset paths may be reconnected to a vertex: it emits or has lobes that are rough enough.
bool is_connectable(const PathVertex& vertex, bool emits, const LobeSelection& lobes) {
  return is_black(vertex.bsdf.straight_transmittance()) && (emits || count_kinds(vertex.bsdf, lobes).connectable > 0);
}
bool is_connectable(const BaseEdge& edge, const LobeSelection& lobes) {
  if (!edge.hit) return true;
  return edge.vertex ? is_connectable(*edge.vertex, edge.emits, lobes) : edge.emits;
}

/// Whether a vertex shows the same side, and so the same BSDF, to a direction as to the one it was shaded for.
bool same_side(const PathVertex& vertex, const Vec3& direction) {
  const Vec3 wo = vertex.to_world(vertex.wo);
  const auto same = [&](Normal3 n) { return (dot(n, direction) > 0) == (dot(n, wo) > 0); };
  return same(vertex.frame.n) && same(vertex.point.shading_normal) && same(vertex.point.geometric_normal);
}

}  // namespace

Departure make_departure(const PathVertex& vertex, const BsdfSample& sample, const LobeSelection& lobes, float u) {
  using Kind = Departure::Kind;
  Departure departure{.kind = Kind::delta, .position = vertex.point.position, .wo = vertex.wo, .wi = sample.direction};
  const bool transmitted = vertex.wo.z * sample.direction.z < 0;
  if (sample.delta) {
    const auto delta = vertex.bsdf.delta(vertex.wo, transmitted);
    departure.probability = delta ? delta->probability : 0;
    return departure;
  }
  const float connectable = pdf_of_kind(vertex, sample.direction, sample.pdf_solid_angle, Kind::connectable, lobes);
  departure.kind = u * sample.pdf_solid_angle < connectable ? Kind::connectable : Kind::other;
  departure.probability = departure.kind == Kind::connectable
                              ? connectable
                              : pdf_of_kind(vertex, sample.direction, sample.pdf_solid_angle, Kind::other, lobes);
  if (transmitted) {
    const auto eta = refractive_index(vertex.bsdf);
    if (eta) departure.eta = *eta;
  }
  return departure;
}

void OffsetPath::start(const Ray& camera_ray) {
  *this = OffsetPath();
  ray_ = camera_ray;
  origin_ = {.position = camera_ray.origin};
}

void OffsetPath::fail(ShiftFailure reason) {
  state_ = State::failed;
  failure_ = reason;
  base_weight_ = 1, offset_weight_ = ratio_ = 0;
}

/// Power heuristic with exponent 2 between both senses of the shift, whose densities are 1 and `ratio_`.
void OffsetPath::scale(Rgb throughput, float ratio) {
  throughput_ *= throughput;
  ratio_ *= ratio;
  if (is_black(throughput_) || !(ratio_ > 0)) return fail(ShiftFailure::black);
  base_weight_ = 1 / (1 + ratio_ * ratio_);
  offset_weight_ = 1 / (1 / ratio_ + ratio_);
}

void OffsetPath::follow(PathContext& context, const LobeSelection& lobes, const BaseEdge& edge) {
  if (state_ != State::separate) return;
  const Departure& base = edge.departure;
  if (base.kind != Departure::Kind::straight && !(base.probability > 0)) return fail(ShiftFailure::not_connectable);
  switch (base.kind) {
    case Departure::Kind::straight:
      break;
    case Departure::Kind::connectable:
      if (is_connectable(edge, lobes)) return reconnect_to(context, lobes, edge);
      if (!edge.vertex) return stop();  // no light comes from there, neither to the base nor to the offset
      [[fallthrough]];
    case Departure::Kind::other:
      if (!copy_half_vector(lobes, base)) return;
      break;
    case Departure::Kind::delta:
      if (!copy_delta(base)) return;
  }
  trace(context, lobes, edge);
}

void OffsetPath::trace(PathContext& context, const LobeSelection& lobes, const BaseEdge& edge) {
  ++context.rays;
  const Vec3 wo = -ray_.direction;
  hit_ = context.scene.intersect(ray_);
  vertex_.reset();
  if (!edge.vertex) return;
  if (hit_) {
    vertex_.emplace();
    context.scene.shade(*hit_, wo, *vertex_);
    vertex_->edges = edge.edges;
  }
  // From there the shift in the other sense would have reconnected.
  if (edge.departure.kind != Departure::Kind::connectable) return;
  if (!hit_) return fail(ShiftFailure::left_scene);
  const bool emits = !is_black(context.scene.emitters().radiance(*hit_, wo));
  if (is_connectable(*vertex_, emits, lobes)) fail(ShiftFailure::not_connectable);
}

void OffsetPath::reconnect_to(PathContext& context, const LobeSelection& lobes, const BaseEdge& edge) {
  if (!edge.vertex && !edge.emits) return stop();
  const Departure& base = edge.departure;
  const SurfacePoint& from = vertex_->point;
  const auto shifted = edge.hit
                           ? reconnect(base.position, from.position, edge.hit->position, edge.hit->geometric_normal)
                           : reconnect_to_infinity(edge.ray.direction);
  if (!shifted) return fail(shifted.failure());
  const auto& [direction, jacobian] = *shifted;
  if (edge.vertex && !same_side(*edge.vertex, -direction)) return fail(ShiftFailure::back_facing);
  if (!take_direction(vertex_->to_local(direction), jacobian, lobes, base)) return;
  const Point3 start = offset_position(from, direction);
  ++context.rays;
  if (context.scene.occluded(edge.hit ? segment(start, offset_position(*edge.hit, -direction)) : Ray{start, direction}))
    return fail(ShiftFailure::occluded);
  state_ = State::arriving;
  ray_ = {start, direction};
  if (edge.vertex) wo_ = edge.vertex->to_local(-direction);
}

bool OffsetPath::copy_half_vector(const LobeSelection& lobes, const Departure& base) {
  const bool transmitted = base.wo.z * base.wi.z < 0;
  const auto eta = transmitted ? refractive_index(vertex_->bsdf) : 1;
  if (!eta) return fail(ShiftFailure::not_connectable), false;
  const auto shifted = transmitted ? copy_half_vector_of_refraction(base.wo, base.wi, base.eta, vertex_->wo, *eta)
                                   : copy_half_vector_of_reflection(base.wo, base.wi, vertex_->wo);
  if (!shifted) return fail(shifted.failure()), false;
  if (!take_direction(shifted->direction, shifted->jacobian, lobes, base)) return false;
  ray_ = spawn_ray(vertex_->point, vertex_->to_world(shifted->direction));
  return true;
}

/// Mirror image and refracted direction are functions of the direction that is known: in discrete measure, J = 1.
bool OffsetPath::copy_delta(const Departure& base) {
  const bool transmitted = base.wo.z * base.wi.z < 0;
  const auto delta = vertex_->bsdf.delta(vertex_->wo, transmitted);
  if (!delta) return fail(ShiftFailure::not_connectable), false;
  origin_ = {.position = vertex_->point.position, .pdf_solid_angle = delta->probability};
  scale(delta->value / delta->probability, delta->probability / base.probability);
  if (state_ == State::failed) return false;
  ray_ = spawn_ray(vertex_->point, vertex_->to_world(delta->direction));
  return true;
}

/// Scatters the offset at its own vertex. False: its lobes scatter nothing that way.
bool OffsetPath::take_direction(const Vec3& wi, float jacobian, const LobeSelection& lobes, const Departure& base) {
  const float pdf = vertex_->bsdf.pdf_solid_angle(vertex_->wo, wi, k_all_lobes);
  const float pdf_kind = pdf_of_kind(*vertex_, wi, pdf, base.kind, lobes);
  if (!(pdf_kind > 0)) return fail(ShiftFailure::black), false;
  origin_ = {vertex_->point.position, pdf, false};
  scale(vertex_->bsdf.eval(vertex_->wo, wi, k_all_lobes) * (std::abs(wi.z) / pdf),
        pdf_kind * jacobian / base.probability);
  return state_ != State::failed;
}

Rgb OffsetPath::emission(const PathContext& context, const BaseEdge& edge, Rgb base_emission) const {
  if (state_ == State::failed) return Rgb();
  if (state_ == State::merged) return throughput_ * base_emission;
  if (state_ != State::separate && is_black(base_emission)) return Rgb();
  const Vec3 direction = state_ == State::leaving ? edge.ray.direction : ray_.direction;
  const std::optional<SurfacePoint>& hit = state_ == State::separate ? hit_ : edge.hit;
  return throughput_ * (hit ? emitted_radiance(context, *hit, -direction, origin_)
                            : environment_radiance(context, direction, origin_));
}

void OffsetPath::arrive() {
  if (state_ == State::separate && !vertex_) fail(ShiftFailure::left_scene);
}

void OffsetPath::pass_or_scatter(const PathVertex& base, bool passes, float base_pass) {
  if (state_ == State::failed || state_ == State::arriving) return;  // nothing passes where paths are reconnected
  const bool separate = state_ == State::separate;
  const PathVertex& vertex = separate ? *vertex_ : base;
  const float pass = separate ? vertex.bsdf.pass_probability(vertex.wo) : base_pass;
  const float probability = passes ? pass : 1 - pass, base_probability = passes ? base_pass : 1 - base_pass;
  if (!(probability > 0)) return fail(ShiftFailure::not_connectable);
  scale((passes ? vertex.bsdf.straight_transmittance() : Rgb(1)) / probability, probability / base_probability);
  if (!passes) return;
  origin_.pdf_solid_angle *= pass;
  if (separate) ray_ = pass_on(ray_, vertex.point);
}

Rgb OffsetPath::next_event(PathContext& context) const {
  const PathVertex& vertex = *vertex_;
  const auto light = choose_emitter(context, vertex);
  if (!light) return Rgb();
  const Vec3 wi = vertex.to_local(light->wi);
  const float pdf = light->pdf_solid_angle;
  const Rgb scattered = throughput_ * vertex.bsdf.eval(vertex.wo, wi, k_all_lobes) * (std::abs(wi.z) / pdf);
  if (is_black(scattered)) return Rgb();
  const Passage passage =
      connect(context, shadow_ray(vertex.point, *light), vertex.edges + 1, context.settings.max_depth);
  if (is_black(passage.transmittance)) return Rgb();
  const float mis =
      light->delta
          ? 1
          : power_heuristic(pdf, vertex.bsdf.pdf_solid_angle(vertex.wo, wi, k_all_lobes) * passage.probability);
  return scattered * passage.transmittance * light->radiance * mis;
}

Rgb OffsetPath::arriving_weight(const PathVertex& base, const Vec3& wi, const DirectSample& light) const {
  return throughput_ * base.bsdf.eval(wo_, wi, k_all_lobes) * (std::abs(wi.z) / light.pdf_solid_angle);
}

float OffsetPath::arriving_mis(const PathVertex& base, const Vec3& wi, const DirectSample& light,
                               const Passage& passage) const {
  if (light.delta) return 1;
  return power_heuristic(light.pdf_solid_angle, base.bsdf.pdf_solid_angle(wo_, wi, k_all_lobes) * passage.probability);
}

void OffsetPath::leave(const PathVertex& base, const BsdfSample& sample) {
  switch (state_) {
    case State::separate:
    case State::failed:
      return;
    case State::leaving:
      state_ = State::merged;
      [[fallthrough]];
    case State::merged:
      return scale(sample.weight, 1);
    case State::arriving:
      break;
  }
  if (sample.delta) return fail(ShiftFailure::not_connectable);
  const float pdf = base.bsdf.pdf_solid_angle(wo_, sample.direction, k_all_lobes);
  if (!(pdf > 0)) return fail(ShiftFailure::black);
  state_ = State::leaving;
  origin_ = {base.point.position, pdf, false};
  scale(base.bsdf.eval(wo_, sample.direction, k_all_lobes) * (std::abs(sample.direction.z) / pdf),
        pdf / sample.pdf_solid_angle);
}

}  // namespace gradslc
