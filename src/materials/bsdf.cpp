#include "materials/bsdf.h"

#include <algorithm>

namespace gradslc {
namespace {

/// std::visit(), where the commonest lobe needs no call through a table.
template <class Function>
auto visit_lobe(const Lobe& lobe, const Function& function) {
  if (const auto* lambert = std::get_if<Lambert>(&lobe)) return function(*lambert);
  return std::visit(function, lobe);
}

float energy_of(const Bsdf::Entry& entry, const Vec3& known) {
  return max_channel(entry.weight * visit_lobe(entry.lobe, [&](const auto& lobe) { return lobe.energy(known); }));
}

/// `function` of a lobe that has a density; `otherwise` for delta lobes.
template <class Result, class Function>
Result unless_delta(const Bsdf::Entry& entry, Result otherwise, const Function& function) {
  return visit_lobe(entry.lobe, [&](const auto& lobe) {
    if constexpr (std::decay_t<decltype(lobe)>::k_delta)
      return otherwise;
    else
      return function(lobe);
  });
}

/// The selected lobes and the energies that they are chosen by.
struct Choice {
  float energies[Bsdf::k_max_lobes] = {};
  float total = 0;

  template <class Entries>
  Choice(const Entries& entries, const Vec3& known, const LobeSelection& lobes) {
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (lobes.includes(entries[i].roughness)) total += energies[i] = energy_of(entries[i], known);
  }

  struct Chosen {
    std::size_t index;
    float u;  // what is left of the random number, stretched to [0,1)
  };
  Chosen choose(float u_lobe) const {
    if (total == 0) return {0, 0};
    std::size_t chosen = 0;
    float below = 0;
    for (std::size_t i = 0; i < Bsdf::k_max_lobes; ++i) {
      if (energies[i] == 0) continue;
      chosen = i;
      if (u_lobe * total < below + energies[i]) break;
      below += energies[i];
    }
    return {chosen, std::clamp((u_lobe * total - below) / energies[chosen], 0.0f, k_one_minus_epsilon)};
  }

  /// Density of the directions that are sampled by this choice, 1/sr; total > 0.
  template <class Entries>
  float pdf_solid_angle(const Entries& entries, const Vec3& known, const Vec3& w) const {
    float sum = 0;
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (energies[i] > 0)
        sum += energies[i] *
               unless_delta(entries[i], 0.0f, [&](const auto& lobe) { return lobe.pdf_solid_angle(known, w); });
    return sum / total;
  }
};

}  // namespace

void Bsdf::add(const Bsdf& other, Rgb weight) {
  for (const Entry& entry : other.entries_) {
    entries_.push_back(entry);
    entries_.back().weight *= weight;
  }
  straight_transmittance_ += other.straight_transmittance_ * weight;
}

Rgb Bsdf::eval(const Vec3& wo, const Vec3& wi, const LobeSelection& lobes) const {
  const Split f = eval_split(wo, wi, lobes);
  return f.connectable + f.other;
}

Bsdf::Split Bsdf::eval_split(const Vec3& wo, const Vec3& wi, const LobeSelection& lobes) const {
  Split sum;
  for (const Entry& entry : entries_)
    if (lobes.includes(entry.roughness))
      (lobes.is_connectable(entry.roughness) ? sum.connectable : sum.other) +=
          entry.weight * unless_delta(entry, Rgb(), [&](const auto& lobe) { return lobe.eval(wo, wi); });
  return sum;
}

std::optional<BsdfSample> Bsdf::sample_only(const Vec3& known, float u_lobe, Vec2 u, Transport transport) const {
  const Entry& entry = entries_[0];
  auto sample = visit_lobe(entry.lobe, [&](const auto& lobe) { return lobe.sample(known, u_lobe, u, transport); });
  if (sample) sample->weight *= entry.weight;
  return sample;
}

std::optional<BsdfSample> Bsdf::sample(const Vec3& known, float u_lobe, Vec2 u, const LobeSelection& lobes,
                                       Transport transport) const {
  if (entries_.size() == 1)
    return lobes.includes(entries_[0].roughness) ? sample_only(known, u_lobe, u, transport)
                                                 : std::optional<BsdfSample>();
  const Choice choice(entries_, known, lobes);
  const auto [chosen, u_choice] = choice.choose(u_lobe);
  const auto sample_lobe = [&, u_choice = u_choice](const auto& lobe) {
    return lobe.sample(known, u_choice, u, transport);
  };
  auto sample = choice.total > 0 ? visit_lobe(entries_[chosen].lobe, sample_lobe) : std::optional<BsdfSample>();
  if (!sample) return sample;
  if (choice.energies[chosen] == choice.total) {  // nothing to choose from
    sample->weight *= entries_[chosen].weight;
    return sample;
  }
  if (sample->delta) {
    const float probability = choice.energies[chosen] / choice.total;
    sample->weight *= entries_[chosen].weight / probability;
    sample->pdf_solid_angle *= probability;
    return sample;
  }
  const Vec3 w = sample->direction;
  sample->pdf_solid_angle = choice.pdf_solid_angle(entries_, known, w);
  if (!(sample->pdf_solid_angle > 0)) {
    sample.reset();
    return sample;
  }
  const Rgb f = transport == Transport::radiance ? eval(known, w, lobes) : eval(w, known, lobes);
  sample->weight = f * (std::abs(w.z) / sample->pdf_solid_angle);
  return sample;
}

float Bsdf::pdf_solid_angle(const Vec3& known, const Vec3& w, const LobeSelection& lobes) const {
  if (entries_.size() == 1) {
    if (!lobes.includes(entries_[0].roughness)) return 0;
    return unless_delta(entries_[0], 0.0f, [&](const auto& lobe) { return lobe.pdf_solid_angle(known, w); });
  }
  const Choice choice(entries_, known, lobes);
  return choice.total == 0 ? 0 : choice.pdf_solid_angle(entries_, known, w);
}

std::optional<DeltaScattering> Bsdf::delta(const Vec3& known, bool transmitted) const {
  constexpr float k_same_direction = 1e-8f;  // squared distance
  const Choice choice(entries_, known, LobeSelection());
  DeltaScattering sum;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (choice.energies[i] == 0) continue;
    const auto& [lobe, weight, roughness] = entries_[i];
    if (roughness != k_delta_roughness) continue;
    // Lobes that do both reflect for small numbers and refract for large ones.
    const float u_choice = transmitted ? k_one_minus_epsilon : 0;
    const auto sample =
        std::visit([&](const auto& any) { return any.sample(known, u_choice, Vec2(), Transport::radiance); }, lobe);
    if (!sample || (sample->direction.z * known.z < 0) != transmitted) continue;
    if (sum.probability > 0 && length_squared(sum.direction - sample->direction) > k_same_direction)
      return std::nullopt;
    sum.direction = sample->direction;
    sum.value += weight * sample->weight * sample->pdf_solid_angle;
    sum.probability += choice.energies[i] / choice.total * sample->pdf_solid_angle;
  }
  if (sum.probability == 0) return std::nullopt;
  return sum;
}

float Bsdf::energy(const Vec3& known, const LobeSelection& lobes) const { return Choice(entries_, known, lobes).total; }

ReflectionBound Bsdf::connectable_bound(const Vec3& known, const LobeSelection& lobes) const {
  ReflectionBound sum;
  for (const Entry& entry : entries_) {
    if (!lobes.is_connectable(entry.roughness)) continue;
    const ReflectionBound bound =
        unless_delta(entry, ReflectionBound(), [&](const auto& lobe) { return lobe.reflection_bound(known); });
    sum += bound.scaled(max_channel(entry.weight));
  }
  return sum;
}

ValueBound Bsdf::connectable_value_bound(const Vec3& known, const LobeSelection& lobes) const {
  ValueBound sum;
  for (const Entry& entry : entries_) {
    if (!lobes.is_connectable(entry.roughness)) continue;
    const auto bound = unless_delta(entry, ValueBound(), [&](const auto& lobe) {
      if constexpr (requires { lobe.gloss_bound(known); })
        return ValueBound{0, lobe.gloss_bound(known)};
      else
        return ValueBound{lobe.max_pi_f(known), {}};
    });
    const float weight = max_channel(entry.weight);
    sum.broad += weight * bound.broad;
    sum.gloss += bound.gloss.scaled(weight);
  }
  return sum;
}

bool Bsdf::has(const LobeSelection& lobes) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    if (!lobes.includes(entry.roughness)) return false;
    return !is_black(entry.weight * std::visit([](const auto& lobe) { return lobe.feature_albedo(); }, entry.lobe));
  });
}

bool Bsdf::transmits(const LobeSelection& lobes) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return lobes.includes(entry.roughness) && std::visit([](const auto& lobe) { return lobe.k_transmits; }, entry.lobe);
  });
}

float Bsdf::pass_probability(const Vec3& known) const {
  const float passes = max_channel(straight_transmittance_);
  if (passes == 0) return 0;
  return passes / (passes + energy(known, LobeSelection()));
}

std::optional<Rgb> Bsdf::lambert_albedo(const Vec3& known, const LobeSelection& lobes) const {
  Rgb sum;
  for (const Entry& entry : entries_) {
    if (!lobes.is_connectable(entry.roughness)) continue;
    const auto* lambert = std::get_if<Lambert>(&entry.lobe);
    if (!lambert) return std::nullopt;
    if (known.z > 0) sum += entry.weight * lambert->albedo;
  }
  return sum;
}

Rgb Bsdf::albedo() const {
  Rgb sum = straight_transmittance_;
  for (const Entry& entry : entries_)
    sum += entry.weight * std::visit([](const auto& lobe) { return lobe.feature_albedo(); }, entry.lobe);
  return sum;
}

}  // namespace gradslc
