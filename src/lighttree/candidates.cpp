#include "lighttree/candidates.h"

#include <algorithm>

#include "lighttree/cluster_kernel.h"

namespace gradslc {

CandidateReceiver make_candidate_receiver(const GatherPoint& point, int least_k, int most_k) {
  CandidateReceiver r{.receiver = make_receiver(point), .diffuse = {}, .least_k = least_k, .most_k = most_k};
  const auto albedo = point.x.bsdf.lambert_albedo(point.x.wo, point.lobes);
  r.lambert = albedo.has_value();
  r.diffuse = albedo ? *albedo : Rgb(r.receiver.bound.cosine);
  return r;
}

void CandidateSet::assign(const VplSet& set, std::span<const Candidate> candidates, int comb_size) {
  size_ = candidates.size();
  const std::size_t groups = (size_ + k_lanes - 1) / k_lanes;
  vpls_.resize(size_), weights_.resize(size_), lambert_.resize(size_);
  glossy_ = false;
  for (Column* column :
       {&position_[0], &position_[1], &position_[2], &geometric_[0], &geometric_[1], &geometric_[2], &shading_[0],
        &shading_[1],  &shading_[2],  &flux_[0],     &flux_[1],      &flux_[2],      &strength_,     &vertex_,
        &broad_,       &peak_,        &tail_,        &alpha2_,       &mirrored_[0],  &mirrored_[1],  &mirrored_[2]})
    column->assign(groups, Lanes{});
  geometry_.resize(groups), summed_.resize(groups);
  const auto put = [](Column& column, std::size_t i, float value) { column[i / k_lanes].values[i % k_lanes] = value; };
  const auto put_vec = [&](Column(&columns)[3], std::size_t i, Vec3 v) {
    put(columns[0], i, v.x), put(columns[1], i, v.y), put(columns[2], i, v.z);
  };
  for (std::size_t i = 0; i < size_; ++i) {
    const Vpl& vpl = set.vpls[candidates[i].vpl];
    vpls_[i] = candidates[i].vpl;
    const double expected = static_cast<double>(comb_size) * candidates[i].probability;
    weights_[i] = static_cast<float>(static_cast<double>(candidates[i].count) / expected);
    lambert_[i] = vpl.is_lambert() ? 1 : 0;
    put_vec(position_, i, from_origin(vpl.position));
    put_vec(geometric_, i, vpl.geometric_normal.decode());
    const Vec3 shading_normal = vpl.shading_normal.decode();
    put_vec(shading_, i, set.transmits(vpl) ? Vec3() : shading_normal);  // zero: lights both sides
    const Rgb flux = weights_[i] * vpl.flux;
    put_vec(flux_, i, {flux.r, flux.g, flux.b});
    put(vertex_, i, static_cast<float>(vpl.vertex));
    put(alpha2_, i, 1);
    if (vpl.is_lambert()) {
      put(strength_, i, vpl.max_pi_f), put(broad_, i, 1);
      continue;
    }
    const VplSurface& surface = set.surfaces[vpl.surface];
    put(strength_, i, 1), put(broad_, i, surface.bound.broad);
    if (surface.bound.gloss.peak == 0) continue;
    glossy_ = true;
    put(peak_, i, surface.bound.gloss.peak), put(tail_, i, surface.bound.gloss.tail);
    put(alpha2_, i, surface.bound.gloss.alpha2);
    put_vec(mirrored_, i, mirrored(vpl.incoming.decode(), shading_normal));
  }
}

void CandidateSet::evaluate(const CandidateReceiver& r, float bound) {
  const Receiver& x = r.receiver;
  const FloatV zero = 0;
  FloatV sum = 0;
  const bool reflects_gloss = x.bound.gloss.peak > 0;
  const float max_diffuse = max_channel(r.diffuse);
  for (std::size_t group = 0; group < geometry_.size(); ++group) {
    const FloatV dx = load(position_[0], group) - x.position.x, dy = load(position_[1], group) - x.position.y,
                 dz = load(position_[2], group) - x.position.z;
    const FloatV distance2 = dx * dx + dy * dy + dz * dz;
    const FloatV along_x = dx * x.normal.x + dy * x.normal.y + dz * x.normal.z;  // cos_x times distance
    const FloatV along_y =
        dx * load(geometric_[0], group) + dy * load(geometric_[1], group) + dz * load(geometric_[2], group);
    const FloatV facing = dx * load(shading_[0], group) + dy * load(shading_[1], group) + dz * load(shading_[2], group);
    const FloatV per_distance2 = 1 / distance2;
    // Both cosines over the squared distance; the largest pi f of both in `strength`.
    FloatV geometry = stdx::abs(along_x * along_y) * per_distance2 * per_distance2;
    const FloatV vertex = load(vertex_, group);
    auto dark = !(distance2 > zero) || facing > zero || vertex < static_cast<float>(r.least_k) ||
                vertex > static_cast<float>(r.most_k);
    if (!x.transmits) dark = dark || along_x <= zero;
    stdx::where(dark, geometry) = 0;

    FloatV emitted = load(broad_, group);
    FloatV per_distance = 0;
    if (glossy_ || reflects_gloss) per_distance = stdx::sqrt(per_distance2);
    if (glossy_) {
      const FloatV cosine =
          -(dx * load(mirrored_[0], group) + dy * load(mirrored_[1], group) + dz * load(mirrored_[2], group)) *
          per_distance;
      emitted += bounded_gloss(load(peak_, group), load(tail_, group), load(alpha2_, group), cosine);
    }
    FloatV reflected = max_diffuse;
    FloatV target = stdx::max(stdx::max(r.diffuse.r * load(flux_[0], group), r.diffuse.g * load(flux_[1], group)),
                              r.diffuse.b * load(flux_[2], group));
    if (!r.lambert) {
      // Bounds of pi f |cos|, over the cosine that the geometric factor holds.
      const FloatV largest_flux =
          stdx::max(stdx::max(load(flux_[0], group), load(flux_[1], group)), load(flux_[2], group));
      FloatV other = x.bound.constant;
      if (reflects_gloss) {
        const FloatV cosine = (dx * x.mirrored.x + dy * x.mirrored.y + dz * x.mirrored.z) * per_distance;
        other +=
            bounded_gloss(FloatV(x.bound.gloss.peak), FloatV(x.bound.gloss.tail), FloatV(x.bound.gloss.alpha2), cosine);
      }
      other /= stdx::abs(along_x) * stdx::sqrt(per_distance2);
      stdx::where(geometry == 0, other) = 0;
      reflected += other;
      target += largest_flux * other;
    }
    target *= emitted;
    const FloatV strength = reflected * emitted * load(strength_, group) * geometry;
    FloatV bounded = bound / strength;
    stdx::where(!(strength > bound), bounded) = 1;
    geometry *= bounded;
    geometry.copy_to(geometry_[group].values.data(), stdx::vector_aligned);
    target *= geometry;
    stdx::where(geometry == zero, target) = 0;
    sum += target;
    sum.copy_to(summed_[group].values.data(), stdx::vector_aligned);
  }
}

float CandidateSet::target(std::uint32_t candidate) const {
  const std::size_t group = candidate / k_lanes, lane = candidate % k_lanes;
  return summed_[group].values[lane] - (group > 0 ? summed_[group - 1].values[lane] : 0);
}

void CandidateSet::choose(int samples, double u, std::vector<CandidateDraw>& draws) const {
  draws.clear();
  if (summed_.empty()) return;
  std::array<double, k_lanes> end_of_lane;
  double total = 0;
  for (std::size_t lane = 0; lane < k_lanes; ++lane)
    end_of_lane[lane] = total += static_cast<double>(summed_.back().values[lane]);
  if (!(total > 0)) return;
  std::size_t lane = 0;
  for (int s = 0; s < samples; ++s) {
    const double position = (s + u) / samples * total;
    while (lane + 1 < k_lanes && position >= end_of_lane[lane]) ++lane;
    const auto within = static_cast<float>(position - (lane > 0 ? end_of_lane[lane - 1] : 0));
    // The first group whose sum exceeds the position within the lane.
    std::size_t low = 0, high = summed_.size() - 1;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (summed_[middle].values[lane] > within)
        high = middle;
      else
        low = middle + 1;
    }
    const auto candidate = static_cast<std::uint32_t>(low * k_lanes + lane);
    const double probability = static_cast<double>(target(candidate)) / total;
    if (!(probability > 0)) continue;  // rounding at a lane's end
    if (!draws.empty() && draws.back().candidate == candidate)
      ++draws.back().count;
    else
      draws.push_back({candidate, 1, probability});
  }
}

Rgb CandidateSet::contribution(const CandidateReceiver& receiver, std::uint32_t candidate) const {
  const Rgb flux(at(flux_[0], candidate), at(flux_[1], candidate), at(flux_[2], candidate));
  return receiver.diffuse * flux * (k_inv_pi * k_inv_pi * at(geometry_, candidate));
}

}  // namespace gradslc
