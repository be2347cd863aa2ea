#include "vpl/light_tracing.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace gradslc {
namespace {

/// Leaves the VPL of a particle of `flux` at y, whose `wo` points back along the particle's path, if there is a
/// connectable lobe.
void deposit(const ShadedPoint& y, Vec3 wi, Rgb flux, int vertex, const LobeSelection& lobes, VplSet& set) {
  const float cos_geometric = std::abs(dot(wi, y.point.geometric_normal));
  if (y.bsdf.energy(y.wo, lobes.only_connectable()) == 0 || cos_geometric == 0) return;
  Vpl vpl;
  vpl.position = y.point.position;
  vpl.flux = flux * (std::abs(y.wo.z) / cos_geometric);
  vpl.geometric_normal = OctahedralNormal(as_vec(face_forward(y.point.geometric_normal, as_vec(y.frame.n))));
  vpl.shading_normal = OctahedralNormal(as_vec(y.frame.n));
  vpl.incoming = OctahedralNormal(wi);
  vpl.set_error(y.point.error);
  vpl.vertex = static_cast<std::uint16_t>(vertex);
  if (const auto albedo = y.bsdf.lambert_albedo(y.wo, lobes)) {
    vpl.flux *= *albedo;
    vpl.max_pi_f = max_channel(*albedo);
  } else {
    const ValueBound bound = y.bsdf.connectable_value_bound(y.wo, lobes);
    vpl.max_pi_f = bound.max();
    vpl.surface = static_cast<std::uint32_t>(set.surfaces.size());
    set.surfaces.push_back({.material = y.point.material,
                            .uv = y.point.uv,
                            .tangent = OctahedralNormal(y.frame.s),
                            .bound = bound,
                            .behind = dot(wi, y.point.shading_normal) < 0,
                            .transmits = y.bsdf.transmits(lobes.only_connectable())});
  }
  set.vpls.push_back(vpl);
}

/// Leaves the VPL of a path of `flux` at its start on an area light: diffuse emission is a Lambert lobe of albedo 1
/// that the whole flux has come to.
void deposit_on_emitter(const EmittingPoint& origin, Rgb flux, VplSet& set) {
  Vpl vpl;
  vpl.position = origin.position;
  vpl.flux = flux;
  vpl.max_pi_f = 1;
  vpl.geometric_normal = vpl.shading_normal = vpl.incoming = OctahedralNormal(as_vec(origin.normal));
  vpl.set_error(origin.error);
  set.vpls.push_back(vpl);
}

/// How a particle goes on from a vertex.
struct Step {
  Ray ray;
  Rgb weight;
  bool crosses = false;  ///< passes straight through
  bool delta = false;    ///< scattered by a delta lobe
};

std::optional<Step> scatter(const ShadedPoint& y, Vec3 wi, const LightTracingSettings& settings,
                            const SampleStream& random, std::uint32_t vertex) {
  const float u_lobe = random.get1(Use::lobe, vertex);
  const auto scattered =
      y.bsdf.sample(y.wo, u_lobe, random.get2(Use::direction, vertex), settings.lobes, Transport::particles);
  if (!scattered) return std::nullopt;
  const Vec3 wo = y.to_world(scattered->direction);
  const float cos_wi_geometric = std::abs(dot(wi, y.point.geometric_normal));
  if (cos_wi_geometric == 0 || scattered->direction.z == 0) return std::nullopt;
  // Adjoint of shading normals: |wi.ns| |wo.ng| / (|wi.ng| |wo.ns|) (Veach 1997, eq. 5.19).
  const float adjoint = std::abs(y.wo.z) * std::abs(dot(wo, y.point.geometric_normal)) /
                        (cos_wi_geometric * std::abs(scattered->direction.z));
  return Step{.ray = spawn_ray(y.point, wo), .weight = scattered->weight * adjoint, .delta = scattered->delta};
}

/// The particle on `ray` either passes straight through the surface at y or is scattered there, one of them drawn.
std::optional<Step> pass_or_scatter(const ShadedPoint& y, const Ray& ray, const LightTracingSettings& settings,
                                    const SampleStream& random, std::uint32_t vertex) {
  const float pass = y.bsdf.pass_probability(y.wo);
  if (pass > 0 && random.get1(Use::crossing, vertex) < pass)
    return Step{.ray = pass_on(ray, y.point), .weight = y.bsdf.straight_transmittance() / pass, .crosses = true};
  auto step = scatter(y, -ray.direction, settings, random, vertex);
  if (step) step->weight *= 1 / (1 - pass);
  return step;
}

/// Appends the VPLs of one light path; returns the rays that it took.
std::uint64_t trace_light_path(const Scene& scene, const LightTracingSettings& settings, std::uint64_t path,
                               VplSet& set) {
  const std::uint64_t sample = settings.set * static_cast<std::uint64_t>(settings.light_paths) + path;
  const SampleStream random(settings.sampler, settings.seed, sample >> 32, static_cast<std::uint32_t>(sample));
  const double u_emitter = random.get1_double(Use::emission_emitter);
  const Vec2 u_point = random.get2(Use::emission_point);
  const Vec2 u_direction = random.get2(Use::emission_direction);
  const EmissionSample emission = scene.emitters().sample_emission(u_emitter, u_point, u_direction);
  Rgb flux = emission.power / static_cast<float>(settings.light_paths);
  if (settings.on_emitters && emission.origin) deposit_on_emitter(*emission.origin, flux, set);
  Ray ray = emission.ray;
  bool has_scattered = false;
  std::uint64_t rays = 0;
  for (int k = 1; k <= settings.max_bounces; ++k) {
    ++rays;
    const auto hit = scene.intersect(ray);
    if (!hit) break;
    const Vec3 wi = -ray.direction;
    const ShadedPoint y = scene.shade(*hit, wi);
    deposit(y, wi, flux, k, settings.lobes, set);
    if (k == settings.max_bounces) break;

    const auto vertex = static_cast<std::uint32_t>(k);
    const auto step = pass_or_scatter(y, ray, settings, random, vertex);
    if (!step) break;
    // A delta emitter's light that is scattered into a discrete direction first is found by no camera path (DESIGN 2).
    if (emission.delta && !has_scattered && step->delta) break;
    has_scattered |= !step->crosses;
    const float survival = std::min(1.0f, max_channel(step->weight));
    if (random.get1(Use::roulette, vertex) >= survival) break;
    flux *= step->weight / survival;
    ray = step->ray;
  }
  return rays;
}

/// What the chunks of a round have left, appended in the chunks' order. Fresh surfaces are numbered within a part.
void append(std::vector<VplSet>& parts, VplSet& set) {
  std::vector<std::size_t> first_vpl{set.vpls.size()}, first_surface{set.surfaces.size()};
  for (const VplSet& part : parts) {
    first_vpl.push_back(first_vpl.back() + part.vpls.size());
    first_surface.push_back(first_surface.back() + part.surfaces.size());
  }
  if (first_vpl.back() > VplSet::k_most)
    throw_failure("light tracing", "more than 2^31 VPLs in one set; fewer light_paths would fit");
  set.vpls.resize(first_vpl.back());
  set.surfaces.resize(first_surface.back());
  parallel_for(parts.size(), 1, [&](std::size_t c, std::size_t) {
    VplSet& part = parts[c];
    for (Vpl& vpl : part.vpls)
      if (!vpl.is_lambert()) vpl.surface += static_cast<std::uint32_t>(first_surface[c]);
    std::copy(part.vpls.begin(), part.vpls.end(), set.vpls.begin() + static_cast<std::ptrdiff_t>(first_vpl[c]));
    std::copy(part.surfaces.begin(), part.surfaces.end(),
              set.surfaces.begin() + static_cast<std::ptrdiff_t>(first_surface[c]));
    part.vpls.clear(), part.surfaces.clear();
  });
}

/// Makes room for what all paths are going to leave when `done` of them have left the set, so that it need not move
/// while it grows. Room that is not used costs no memory.
void reserve_for_all(VplSet& set, std::size_t done, std::size_t paths) {
  const double scale = 1.05 * static_cast<double>(paths) / static_cast<double>(done);
  set.vpls.reserve(static_cast<std::size_t>(scale * static_cast<double>(set.vpls.size())));
  set.surfaces.reserve(static_cast<std::size_t>(scale * static_cast<double>(set.surfaces.size())));
}

}  // namespace

VplSet trace_vpls(const Scene& scene, const LightTracingSettings& settings) {
  VplSet set;
  if (scene.emitters().empty()) return set;
  // In rounds, so that what waits to be appended is bounded.
  constexpr std::size_t k_paths_per_chunk = 256, k_chunks_per_round = 1024;
  constexpr std::size_t k_paths_per_round = k_paths_per_chunk * k_chunks_per_round;
  const auto paths = static_cast<std::size_t>(settings.light_paths);
  std::vector<VplSet> parts(std::min(k_chunks_per_round, (paths + k_paths_per_chunk - 1) / k_paths_per_chunk));
  for (std::size_t first = 0; first < paths; first += k_paths_per_round) {
    const std::size_t count = std::min(k_paths_per_round, paths - first);
    set.rays += parallel_sum<std::uint64_t>(count, k_paths_per_chunk, [&](std::size_t begin, std::size_t end) {
      std::uint64_t rays = 0;
      for (std::size_t path = begin; path < end; ++path)
        rays += trace_light_path(scene, settings, first + path, parts[begin / k_paths_per_chunk]);
      return rays;
    });
    append(parts, set);
    if (first == 0 && count < paths) reserve_for_all(set, count, paths);
  }
  return set;
}

}  // namespace gradslc
