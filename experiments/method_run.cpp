#include "experiments/method_run.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "scene/scene.h"

namespace gradslc {
namespace {

constexpr int k_halvings = 7;               // of a budget in seconds, for its curve
constexpr double k_latest_point = 1.1;      // of its planned seconds: later it would not be that point
constexpr std::size_t k_recent_passes = 8;  // that the next pass's time is predicted from

}  // namespace

std::vector<double> curve_targets(const Budget& budget) {
  std::vector<double> targets;
  if (budget.kind == Budget::Kind::spp) {
    for (int k = 0; std::ldexp(1.0, k) < budget.value; ++k) targets.push_back(std::ldexp(1.0, k));
  } else {
    for (int k = k_halvings; k > 0; --k) targets.push_back(std::ldexp(budget.value, -k));
  }
  targets.push_back(budget.value);
  return targets;
}

MethodRun::MethodRun(Plan plan, std::unique_ptr<Integrator> integrator, Reconstructions reconstructions,
                     const Scene& scene, Clock clock)
    : plan_(std::move(plan)),
      integrator_(std::move(integrator)),
      reconstructions_(std::move(reconstructions)),
      scene_(scene),
      clock_(std::move(clock)) {
  assert(!plan_.targets.empty() && std::is_sorted(plan_.targets.begin(), plan_.targets.end()));
  assert(!reconstructions_.empty());
}

double MethodRun::progress() const {
  if (done()) return 1;
  const double used = plan_.budget.kind == Budget::Kind::spp ? passes_ : spent();
  return std::min(1.0, used / plan_.budget.value);
}

std::vector<PointImage> MethodRun::step() {
  assert(!done());
  if (!film_) {
    prepare();
    return {};
  }
  if (passes_ > 0) {
    skip_missed_targets();
    if (point_is_due()) return make_point();
  }
  render_pass();
  return {};
}

void MethodRun::prepare() {
  prepare_ = measure(clock_, [&] {
    integrator_->prepare(scene_, plan_.settings);
    FilmLayers layers = plan_.layers;
    layers.gradients = integrator_->traits().gradients;
    for (const auto& reconstruction : reconstructions_)
      layers.features |= reconstruction && reconstruction->needs_features();
    film_ = std::make_shared<Film>(scene_.camera().resolution(), layers);
  });
}

void MethodRun::render_pass() {
  const Seconds time = measure(clock_, [&] { integrator_->render_pass(static_cast<std::uint32_t>(passes_), *film_); });
  render_ += time;
  const std::size_t slot = static_cast<std::size_t>(passes_) % k_recent_passes;
  if (slot == recent_pass_seconds_.size()) recent_pass_seconds_.push_back(time.wall);
  recent_pass_seconds_[slot] = time.wall;
  ++passes_;
}

double MethodRun::predicted_pass_seconds() const {
  return std::accumulate(recent_pass_seconds_.begin(), recent_pass_seconds_.end(), 0.0) /
         static_cast<double>(recent_pass_seconds_.size());
}

void MethodRun::skip_missed_targets() {
  if (plan_.budget.kind == Budget::Kind::spp) return;
  const auto missed = [&](double target) {
    return passes_ == last_point_passes_ || spent() + reconstruct_seconds_ > k_latest_point * target;
  };
  while (!is_final_target() && point_is_due() && missed(plan_.targets[next_target_])) ++next_target_;
}

bool MethodRun::point_is_due() const {
  const double target = plan_.targets[next_target_];
  if (plan_.budget.kind == Budget::Kind::spp) return passes_ >= target;
  return spent() + predicted_pass_seconds() + reconstruct_seconds_ > target;
}

std::vector<PointImage> MethodRun::make_point() {
  CurvePoint common;
  common.target = plan_.targets[next_target_];
  common.final = is_final_target();
  common.passes = passes_;
  common.prepare = prepare_;
  common.render = render_;
  common.rays = integrator_->statistics().rays;
  common.invalid_samples = film_->invalid_samples();
  common.pass_seconds = predicted_pass_seconds();
  std::vector<PointImage> images;
  reconstruct_seconds_ = 0;
  for (std::size_t i = 0; i < reconstructions_.size(); ++i) {
    FinalImage result;
    CurvePoint point = common;
    point.reconstruct = measure(clock_, [&] { result = final_image(*film_, reconstructions_[i].get()); });
    point.reconstruction = result.reconstruction;
    reconstruct_seconds_ = std::max(reconstruct_seconds_, point.reconstruct.wall);
    images.push_back({i, point, std::move(result.image)});
  }
  for (PointImage& image : images) image.point.waited_seconds = reconstruct_seconds_ - image.point.reconstruct.wall;
  last_point_passes_ = passes_;
  ++next_target_;
  return images;
}

std::shared_ptr<const Film> MethodRun::finished_film() {
  assert(done());
  for (const int half : {0, 1}) film_->close_set(half);
  return film_;
}

}  // namespace gradslc
