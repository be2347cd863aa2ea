// How much of a method's CPU time is spent inside Embree: renders passes on one thread, then sends exactly the rays
// that they have sent, in the same order, through Embree alone.
//
// The linker redirects the renderer's calls of Embree to this file (-Wl,--wrap), which logs them and passes them on:
// the renderer itself knows nothing of it. Rays of prepare() and of a first pass, which fills caches and traces the set
// of "vpl.passes_per_set": 0, are not counted.

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <immintrin.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bench/benchmark_program.h"
#include "core/parallel.h"
#include "experiments/clock.h"
#include "experiments/method_plan.h"
#include "scene/loaders/loader.h"

namespace gradslc {
namespace {

/// What defines a ray, without what Embree returns.
struct LoggedRay {
  float origin[3], near;
  float direction[3], far;
  bool shadow;
};

struct RayLog {
  RTCScene scene = nullptr;
  std::vector<LoggedRay> rays;

  void add(RTCScene of, const RTCRay& ray, bool shadow) {
    scene = of;
    rays.push_back({{ray.org_x, ray.org_y, ray.org_z}, ray.tnear, {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tfar, shadow});
  }
};

RayLog* active_log = nullptr;  // null: rays are passed on only

}  // namespace
}  // namespace gradslc

extern "C" {
void __real_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* hit);
void __real_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray);

void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* hit) {
  if (gradslc::active_log) gradslc::active_log->add(scene, hit->ray, false);
  __real_rtcIntersect1(scene, context, hit);
}
void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
  if (gradslc::active_log) gradslc::active_log->add(scene, *ray, true);
  __real_rtcOccluded1(scene, context, ray);
}
}

namespace gradslc {
namespace {

struct Arguments {
  std::string method = "spt";
  std::vector<std::string> scenes, overrides;
  int spp = 4, width = 0, max_depth = RenderSettings{}.max_depth;
};

/// Seconds of CPU and counts, of all passes.
struct Measurement {
  double render = 0, replay = 0;
  std::size_t samples = 0, closest_hit = 0, shadow = 0;

  double share() const { return replay / render; }
  std::size_t rays() const { return closest_hit + shadow; }
};

// In the pieces that Embree reads, as Scene does it: nothing but Embree is to be measured.
void to_embree(const LoggedRay& logged, RTCRay& ray) {
  const auto& [origin, near, direction, far, shadow] = logged;
  _mm_store_ps(&ray.org_x, _mm_setr_ps(origin[0], origin[1], origin[2], near));
  _mm_store_ps(&ray.dir_x, _mm_setr_ps(direction[0], direction[1], direction[2], 0));
  ray.tfar = far;
  ray.mask = 0xffffffffu;
  ray.id = ray.flags = 0;
}

void replay(const RayLog& log) {
  for (const LoggedRay& logged : log.rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit hit;
    to_embree(logged, hit.ray);
    hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (logged.shadow)
      __real_rtcOccluded1(log.scene, &context, &hit.ray);
    else
      __real_rtcIntersect1(log.scene, &context, &hit);
  }
}

/// A method that renders into a film of its own.
class Rendering {
 public:
  Rendering(const MethodPlan& method, const Scene& scene, const RenderSettings& settings)
      : integrator_(make_integrator(method)), film_(scene.camera().resolution(), {}) {
    integrator_->prepare(scene, settings);
    film_ = Film(scene.camera().resolution(), {.gradients = integrator_->traits().gradients});
  }
  void render_pass(std::uint32_t pass) { integrator_->render_pass(pass, film_); }

 private:
  std::unique_ptr<Integrator> integrator_;
  Film film_;
};

Measurement measure_scene(const Arguments& arguments, const MethodPlan& method, const std::string& file) {
  LoadOptions options;
  options.permissive = true;
  if (arguments.width > 0) options.width = arguments.width;
  const Scene scene(load_scene(file, options));
  RenderSettings settings;
  settings.max_depth = arguments.max_depth;

  Rendering timed(method, scene, settings), logged(method, scene, settings);
  timed.render_pass(0), logged.render_pass(0);
  Measurement sum;
  for (int pass = 1; pass <= arguments.spp; ++pass) {
    sum.render += measure(system_time, [&] { timed.render_pass(static_cast<std::uint32_t>(pass)); }).cpu;
    RayLog log;
    active_log = &log;
    logged.render_pass(static_cast<std::uint32_t>(pass));
    active_log = nullptr;
    sum.replay += measure(system_time, [&] { replay(log); }).cpu;
    for (const LoggedRay& ray : log.rays) ++(ray.shadow ? sum.shadow : sum.closest_hit);
    sum.samples += scene.camera().resolution().pixels();
  }
  return sum;
}

void print_row(const std::string& file, const Measurement& m) {
  const auto samples = static_cast<double>(m.samples);
  fmt::print("{:>9.3f} {:>11.2f} {:>11.2f} {:>11.3f} {:>7.1f} {:>7.3f}  {}\n", m.render * 1e6 / samples,
             static_cast<double>(m.closest_hit) / samples, static_cast<double>(m.shadow) / samples,
             m.replay * 1e6 / samples, m.replay * 1e9 / static_cast<double>(m.rays()), m.share(), file);
}

int run(int argc, char** argv) {
  CLI::App app("CPU time of a method, and of its own rays through Embree alone");
  Arguments arguments;
  app.add_option("SCENES", arguments.scenes, "Mitsuba scene files (.xml)")->required();
  app.add_option("--method", arguments.method, "Integrator's name")->capture_default_str();
  app.add_option("--set", arguments.overrides, "Parameter of the method: key=value")->allow_extra_args(false);
  app.add_option("--spp", arguments.spp, "Passes to measure, after one that is not")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  app.add_option("--width", arguments.width, "Image width (default: the scene's)")->check(CLI::Range(1, 32768));
  app.add_option("--max-depth", arguments.max_depth, "Most edges of a path")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  set_thread_count(1);

  const MethodPlan method = read_method_options(arguments.method, arguments.overrides);
  fmt::print("us/sample hits/sample shadows/smp Embree us/s  ns/ray   share  scene\n");
  for (const std::string& file : arguments.scenes) print_row(file, measure_scene(arguments, method, file));
  return 0;
}

}  // namespace
}  // namespace gradslc

int main(int argc, char** argv) { return gradslc::run_benchmark(gradslc::run, argc, argv); }
