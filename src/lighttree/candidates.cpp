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
  const std::size_t count = candidates.size(), groups = (count + k_lanes - 1) / k_lanes;
  vpls_.resize(count), weights_.resize(count);
  groups_.assign(groups, Group{});
  vertices_.assign(groups, 0);
  tests_.assign(groups, 0), hits_.assign(groups, 0), visibility_.assign(groups, 1);
  geometry_.resize(groups);
  least_vertex_ = k_infinity, most_vertex_ = 0;
  simple_ = true;
  for (std::size_t i = 0; i < count; ++i) {
    const Vpl& vpl = set.vpls[candidates[i].vpl];
    vpls_[i] = candidates[i].vpl;
    const double expected = static_cast<double>(comb_size) * candidates[i].probability;
    weights_[i] = static_cast<float>(static_cast<double>(candidates[i].count) / expected);
    const auto vertex = static_cast<float>(vpl.vertex);
    least_vertex_ = std::min(least_vertex_, vertex), most_vertex_ = std::max(most_vertex_, vertex);
    simple_ = simple_ && vpl.is_lambert() && vpl.shading_normal == vpl.geometric_normal;
  }
  if (!simple_) details_.assign(groups, Details{});
  for (std::size_t i = 0; i < count; ++i) put(set, i);
}

void CandidateSet::put(const VplSet& set, std::size_t index) {
  const Vpl& vpl = set.vpls[vpls_[index]];
  const auto [group_index, lane] = place_of(static_cast<std::uint32_t>(index));
  const auto put_vec = [&](FloatV(&v)[3], Vec3 value) {
    v[0][lane] = value.x, v[1][lane] = value.y, v[2][lane] = value.z;
  };
  Group& group = groups_[group_index];
  put_vec(group.position, from_origin(vpl.position));
  put_vec(group.geometric, vpl.geometric_normal.decode());
  const Rgb flux = weights_[index] * vpl.flux;
  put_vec(group.flux, {flux.r, flux.g, flux.b});
  group.inverse_pi_f_y[lane] = vpl.is_lambert() ? 1 / vpl.max_pi_f : 1;
  vertices_[group_index][lane] = static_cast<float>(vpl.vertex);
  if (simple_) return;
  Details& details = details_[group_index];
  const Vec3 shading_normal = vpl.shading_normal.decode();
  put_vec(details.shading, set.transmits(vpl) ? Vec3() : shading_normal);
  const ValueBound bound = vpl.is_lambert() ? ValueBound{1, {}} : set.surfaces[vpl.surface].bound;
  details.broad[lane] = bound.broad;
  details.peak[lane] = bound.gloss.peak, details.tail[lane] = bound.gloss.tail;
  details.alpha2[lane] = bound.gloss.peak > 0 ? bound.gloss.alpha2 : 1;
  put_vec(details.mirrored, mirrored(vpl.incoming.decode(), shading_normal));
}

void CandidateSet::calibrate(const VplView& vpls, const LobeSelection& lobes, std::span<const Point3> towards) {
  constexpr float k_least_share = 0.02f;  // another of the tile's points may be where the lobe is
  if (simple_) return;
  for (std::uint32_t i = 0; i < size(); ++i) {
    const Vpl& vpl = vpls[vpls_[i]];
    if (vpl.is_lambert()) continue;
    const auto [group, lane] = place_of(i);
    Details& y = details_[group];
    const Vec3 image{y.mirrored[0][lane], y.mirrored[1][lane], y.mirrored[2][lane]};
    const GlossyVpl glossy(vpls, vpl);
    float share = k_least_share;
    for (const Point3 point : towards) {
      const Vec3 d = point - vpl.position;
      const float squared = length_squared(d);
      if (!(squared > 0)) continue;
      const Vec3 wo = d / std::sqrt(squared);
      const float s2 = std::max(0.5f - 0.5f * std::min(dot(wo, image) + k_cosine_slack, 1.0f), 0.0f);
      const float bound =
          y.broad[lane] + std::min<float>(y.peak[lane], y.tail[lane] * gloss_falloff<float>(s2, y.alpha2[lane]));
      if (bound > 0) share = std::max(share, max_channel(glossy.pi_f(wo, lobes)) / bound);
    }
    share = std::min(share, 1.0f);
    y.broad[lane] *= share, y.peak[lane] *= share, y.tail[lane] *= share;
  }
}

CandidateSubset CandidateSet::random_subset(float u) const {
  constexpr std::uint32_t k_stride = 4;
  const auto stride = std::min(k_stride, std::max<std::uint32_t>(static_cast<std::uint32_t>(groups_.size()), 1));
  return {std::min(static_cast<std::uint32_t>(u * static_cast<float>(stride)), stride - 1), stride};
}

void CandidateSet::evaluate(const CandidateReceiver& r, float bound, CandidateSubset subset) {
  summed_.subset = subset;
  summed_.sums.resize((groups_.size() + subset.stride - 1 - subset.first) / subset.stride);
  const bool all_count = static_cast<float>(r.least_k) <= least_vertex_ && most_vertex_ <= static_cast<float>(r.most_k);
  if (simple_ && r.lambert && all_count)
    evaluate_lambert(r, bound);
  else
    evaluate_any(r, bound);
}

[[gnu::flatten]] void CandidateSet::evaluate_lambert(const CandidateReceiver& r, float bound) {
  const FloatV x[3] = {r.receiver.position.x, r.receiver.position.y, r.receiver.position.z};
  const FloatV n[3] = {r.receiver.normal.x, r.receiver.normal.y, r.receiver.normal.z};
  const FloatV diffuse[3] = {r.diffuse.r, r.diffuse.g, r.diffuse.b};
  const FloatV cap = bound / max_channel(r.diffuse), zero = 0;
  FloatV sum = 0;
  auto summed = summed_.sums.begin();
  for (std::size_t i = summed_.subset.first; i < groups_.size(); i += summed_.subset.stride) {
    const Group& g = groups_[i];
    const FloatV d[3] = {g.position[0] - x[0], g.position[1] - x[1], g.position[2] - x[2]};
    const FloatV distance2 = lane_dot(d, d);
    const FloatV along_x = stdx::max(lane_dot(d, n), zero), along_y = stdx::min(lane_dot(d, g.geometric), zero);
    const FloatV per_distance2 = 1 / distance2;
    FloatV geometry = stdx::min(-along_x * along_y * (per_distance2 * per_distance2), cap * g.inverse_pi_f_y);
    stdx::where(!(distance2 > zero), geometry) = 0;
    geometry_[i] = geometry;
    const FloatV flux = stdx::max(stdx::max(diffuse[0] * g.flux[0], diffuse[1] * g.flux[1]), diffuse[2] * g.flux[2]);
    sum += visibility_[i] * geometry * flux;
    *summed++ = sum;
  }
}

[[gnu::flatten]] void CandidateSet::evaluate_any(const CandidateReceiver& r, float bound) {
  const Receiver& x = r.receiver;
  const FloatV position[3] = {x.position.x, x.position.y, x.position.z};
  const FloatV normal[3] = {x.normal.x, x.normal.y, x.normal.z};
  const FloatV image[3] = {x.mirrored.x, x.mirrored.y, x.mirrored.z};
  const FloatV zero = 0;
  FloatV sum = 0;
  auto summed = summed_.sums.begin();
  for (std::size_t i = summed_.subset.first; i < groups_.size(); i += summed_.subset.stride) {
    const Group& g = groups_[i];
    const FloatV d[3] = {g.position[0] - position[0], g.position[1] - position[1], g.position[2] - position[2]};
    const FloatV distance2 = lane_dot(d, d), per_distance2 = 1 / distance2;
    const FloatV along_x = lane_dot(d, normal), along_y = lane_dot(d, g.geometric);
    const FloatV facing = simple_ ? along_y : lane_dot(d, details_[i].shading);
    auto dark = !(distance2 > zero) || facing > zero || vertices_[i] < static_cast<float>(r.least_k) ||
                vertices_[i] > static_cast<float>(r.most_k);
    if (!x.transmits) dark = dark || along_x <= zero;

    FloatV geometry = stdx::abs(along_x * along_y) * (per_distance2 * per_distance2);
    const FloatV per_distance = stdx::sqrt(per_distance2);
    FloatV emitted = 1;
    if (!simple_) {
      const Details& y = details_[i];
      emitted = y.broad + bounded_gloss<FloatV>(y.peak, y.tail, y.alpha2, -lane_dot(d, y.mirrored) * per_distance);
    }
    // Bounds of pi f |cos| over the cosine that the geometric factor holds.
    FloatV other = x.bound.constant;
    if (x.bound.gloss.peak > 0)
      other += bounded_gloss<FloatV>(x.bound.gloss.peak, x.bound.gloss.tail, x.bound.gloss.alpha2,
                                     lane_dot(d, image) * per_distance);
    other /= stdx::abs(along_x) * per_distance;
    const FloatV reflected = max_channel(r.diffuse) + other;
    geometry = stdx::min(geometry, bound * g.inverse_pi_f_y / (reflected * emitted));
    const FloatV diffuse =
        stdx::max(stdx::max(r.diffuse.r * g.flux[0], r.diffuse.g * g.flux[1]), r.diffuse.b * g.flux[2]);
    const FloatV flux = stdx::max(stdx::max(g.flux[0], g.flux[1]), g.flux[2]);
    FloatV target = (diffuse + (r.lambert ? zero : other * flux)) * emitted * geometry * visibility_[i];
    stdx::where(dark || emitted <= zero, geometry) = 0;
    stdx::where(geometry <= zero || flux <= zero, target) = 0;
    geometry_[i] = geometry;
    sum += target;
    *summed++ = sum;
  }
}

void CandidateSet::evaluate(std::span<const CandidateReceiver> receivers, float bound) {
  shared_.assign(groups_.size(), 0);
  for (const CandidateReceiver& receiver : receivers) {
    evaluate(receiver, bound);
    for (std::size_t i = 0; i < shared_.size(); ++i) shared_[i] += summed_.sums[i];
  }
  summed_.subset = {};
  std::swap(summed_.sums, shared_);
}

void CandidateSet::note_visibility(std::uint32_t candidate, bool visible) {
  const auto [group, lane] = place_of(candidate);
  tests_[group][lane] += 1;
  if (visible) hits_[group][lane] += 1;
}

void CandidateSet::learn_visibility() {
  constexpr std::size_t k_neighbours = 4;       // to either side
  constexpr float k_prior = 2;                  // tests that the neighbours' share counts for
  constexpr float k_least_probability = 0.04f;  // nothing is blocked for sure: it may be seen from the next receiver
  const std::size_t groups = groups_.size();
  FloatV tests = 0, hits = 0;  // of the neighbours, and the candidate itself
  for (std::size_t i = 0; i < std::min(k_neighbours, groups); ++i) tests += tests_[i], hits += hits_[i];
  for (std::size_t i = 0; i < groups; ++i) {
    if (const std::size_t next = i + k_neighbours; next < groups) tests += tests_[next], hits += hits_[next];
    if (i > k_neighbours) tests -= tests_[i - k_neighbours - 1], hits -= hits_[i - k_neighbours - 1];
    const FloatV nearby = (hits + 1) / (tests + 2);
    const FloatV seen = (hits_[i] + k_prior * nearby) / (tests_[i] + k_prior);
    visibility_[i] = stdx::sqrt(stdx::max(seen, FloatV(k_least_probability)));
  }
}

void CandidateSet::choose(int samples, double u, std::vector<CandidateDraw>& draws) const {
  draws.clear();
  const auto& [subset, sums] = summed_;
  if (sums.empty()) return;
  std::array<double, k_lanes> end_of_lane;
  double total = 0;
  for (std::size_t lane = 0; lane < k_lanes; ++lane)
    end_of_lane[lane] = total += static_cast<double>(sums.back()[lane]);
  if (!(total > 0)) return;
  std::uint32_t lane = 0;
  for (int s = 0; s < samples; ++s) {
    const double position = (s + u) / samples * total;
    while (lane + 1 < k_lanes && position >= end_of_lane[lane]) ++lane;
    const auto within = static_cast<float>(position - (lane > 0 ? end_of_lane[lane - 1] : 0));
    // The first vector whose sum exceeds the position within the lane, by halving without branches.
    std::uint32_t index = 0;
    for (std::uint32_t left = static_cast<std::uint32_t>(sums.size()) - 1; left > 0;) {
      const std::uint32_t half = (left + 1) / 2;
      index += sums[index + half - 1][lane] > within ? 0 : half;
      left -= half;
    }
    const std::uint32_t candidate = lane * static_cast<std::uint32_t>(groups_.size()) + summed_.group(index);
    const double probability = static_cast<double>(summed_.target(index, lane)) / (total * subset.stride);
    if (!(probability > 0)) continue;  // rounding at a lane's end
    if (!draws.empty() && draws.back().candidate == candidate)
      ++draws.back().count;
    else
      draws.push_back({candidate, 1, probability});
  }
}

Normal3 CandidateSet::geometric_normal(std::uint32_t candidate) const {
  const auto [group, lane] = place_of(candidate);
  const auto& normal = groups_[group].geometric;
  return {normal[0][lane], normal[1][lane], normal[2][lane]};
}

Rgb CandidateSet::contribution(const CandidateReceiver& receiver, std::uint32_t candidate) const {
  const auto [group, lane] = place_of(candidate);
  const auto& flux = groups_[group].flux;
  return receiver.diffuse * Rgb(flux[0][lane], flux[1][lane], flux[2][lane]) *
         (k_inv_pi * k_inv_pi * geometry_[group][lane]);
}

Rgb CandidateSet::contribution(const CandidateReceiver& receiver, std::uint32_t candidate, float bound) const {
  const auto [group, lane] = place_of(candidate);
  const Group& g = groups_[group];
  const auto vec = [lane = lane](const FloatV(&v)[3]) { return Vec3{v[0][lane], v[1][lane], v[2][lane]}; };
  const Vec3 d = vec(g.position) - from_origin(receiver.receiver.position);
  const float distance2 = length_squared(d);
  const float along_x = dot(d, receiver.receiver.normal), along_y = dot(d, vec(g.geometric));
  if (!(distance2 > 0) || along_x <= 0 || along_y >= 0) return Rgb();
  const float cap = bound / max_channel(receiver.diffuse) * g.inverse_pi_f_y[lane];
  const float geometry = std::min(-along_x * along_y / (distance2 * distance2), cap);
  return receiver.diffuse * Rgb(g.flux[0][lane], g.flux[1][lane], g.flux[2][lane]) * (k_inv_pi * k_inv_pi * geometry);
}

}  // namespace gradslc
