#include "vpl/light_tracing.h"

#include <algorithm>
#include <optional>

#include "core/parallel.h"

namespace gradslc {
namespace {

/// The VPL that a particle of `flux` leaves at `y`; `wi_local` points back along its path. nullopt: no connectable lobe
/// there.
std::optional<Vpl> deposit(const SurfacePoint& y, const Bsdf& bsdf, Vec3 wi, Vec3 wi_local, Rgb flux, int vertex,
                           const LobeSelection& lobes) {
  const float cos_geometric = std::abs(dot(wi, y.geometric_normal));
  if (bsdf.energy(wi_local, lobes.only_connectable()) == 0 || cos_geometric == 0) return std::nullopt;
  const float side = std::copysign(1.0f, wi_local.z);
  const Rgb albedo = bsdf.lambert_albedo();
  Vpl vpl;
  vpl.position = y.position;
  vpl.reflected_flux = flux * albedo * (std::abs(wi_local.z) / cos_geometric);
  vpl.max_albedo = max_channel(albedo);
  vpl.geometric_normal = OctahedralNormal(side * as_vec(y.geometric_normal));
  vpl.shading_normal = OctahedralNormal(side * as_vec(y.shading.n));
  vpl.incoming = OctahedralNormal(wi);
  vpl.error = y.error;
  vpl.vertex = static_cast<std::uint32_t>(vertex);
  return vpl;
}

/// Appends the VPLs of one light path; returns the rays that it took.
std::uint64_t trace_light_path(const Scene& scene, const LightTracingSettings& settings, std::uint64_t path,
                               std::vector<Vpl>& vpls) {
  const std::uint64_t sample = settings.set * static_cast<std::uint64_t>(settings.light_paths) + path;
  const SampleStream random(settings.sampler, settings.seed, sample >> 32, static_cast<std::uint32_t>(sample));
  const double u_emitter = random.get1_double(Use::emission_emitter);
  const Vec2 u_point = random.get2(Use::emission_point);
  const Vec2 u_direction = random.get2(Use::emission_direction);
  const EmissionSample emission = scene.emitters().sample_emission(u_emitter, u_point, u_direction);
  Rgb flux = emission.power / static_cast<float>(settings.light_paths);
  Ray ray = spawn_ray(emission.point, emission.direction);
  std::uint64_t rays = 0;
  for (int k = 1; k <= settings.max_bounces; ++k) {
    ++rays;
    const auto y = scene.intersect(ray);
    if (!y) break;
    const Vec3 wi = -ray.direction;
    const Vec3 wi_local = y->shading.to_local(wi);
    const Bsdf bsdf = scene.material(*y).resolve(y->uv);
    if (const auto vpl = deposit(*y, bsdf, wi, wi_local, flux, k, settings.lobes)) vpls.push_back(*vpl);
    if (k == settings.max_bounces) break;

    const auto vertex = static_cast<std::uint32_t>(k);
    const float u_lobe = random.get1(Use::lobe, vertex);
    const auto scattered = bsdf.sample(wi_local, u_lobe, random.get2(Use::direction, vertex), settings.lobes);
    if (!scattered) break;
    const Vec3 wo = y->shading.to_world(scattered->wi);
    const float cos_wi_geometric = std::abs(dot(wi, y->geometric_normal));
    if (cos_wi_geometric == 0 || scattered->wi.z == 0) break;
    // Adjoint of shading normals: |wi.ns| |wo.ng| / (|wi.ng| |wo.ns|) (Veach 1997, eq. 5.19).
    const float adjoint =
        std::abs(wi_local.z) * std::abs(dot(wo, y->geometric_normal)) / (cos_wi_geometric * std::abs(scattered->wi.z));
    const Rgb weight = scattered->weight * adjoint;
    const float survival = std::min(1.0f, max_channel(weight));
    if (random.get1(Use::roulette, vertex) >= survival) break;
    flux *= weight / survival;
    ray = spawn_ray(*y, wo);
  }
  return rays;
}

}  // namespace

VplSet trace_vpls(const Scene& scene, const LightTracingSettings& settings) {
  VplSet set;
  if (scene.emitters().empty()) return set;
  constexpr std::size_t k_paths_per_chunk = 256;
  const auto paths = static_cast<std::size_t>(settings.light_paths);
  const std::size_t chunks = (paths + k_paths_per_chunk - 1) / k_paths_per_chunk;
  std::vector<std::vector<Vpl>> chunk_vpls(chunks);
  set.rays = parallel_sum<std::uint64_t>(paths, k_paths_per_chunk, [&](std::size_t begin, std::size_t end) {
    std::uint64_t rays = 0;
    for (std::size_t path = begin; path < end; ++path)
      rays += trace_light_path(scene, settings, path, chunk_vpls[begin / k_paths_per_chunk]);
    return rays;
  });
  std::vector<std::size_t> first(chunks + 1, 0);
  for (std::size_t c = 0; c < chunks; ++c) first[c + 1] = first[c] + chunk_vpls[c].size();
  set.vpls.resize(first.back());
  parallel_for(chunks, 1, [&](std::size_t c, std::size_t) {
    std::copy(chunk_vpls[c].begin(), chunk_vpls[c].end(), set.vpls.begin() + static_cast<std::ptrdiff_t>(first[c]));
    std::vector<Vpl>().swap(chunk_vpls[c]);
  });
  return set;
}

}  // namespace gradslc
