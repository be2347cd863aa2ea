// What a second thread costs, and how much of the work only one thread does: tracing light paths, building the tree and
// gathering, on one thread and on two, by the threads' own CPU clocks. Wall-clock speed-up cannot be trusted on a
// shared machine; CPU time can.

#include <fmt/format.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <ctime>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "bench/benchmark_program.h"
#include "core/parallel.h"
#include "experiments/method_plan.h"
#include "lighttree/light_tree.h"
#include "scene/loaders/loader.h"
#include "vpl/light_tracing.h"

namespace gradslc {
namespace {

/// CPU seconds of each of OpenMP's threads so far. They stay the same threads while their number does.
std::vector<double> thread_seconds() {
  std::vector<double> seconds(static_cast<std::size_t>(thread_count()));
#pragma omp parallel
  {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    seconds[static_cast<std::size_t>(omp_get_thread_num())] =
        static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  return seconds;
}

/// CPU seconds that `work` takes, thread by thread.
std::vector<double> measure_threads(const std::function<void()>& work) {
  const std::vector<double> begin = thread_seconds();
  work();
  std::vector<double> spent = thread_seconds();
  for (std::size_t i = 0; i < spent.size(); ++i) spent[i] -= begin[i];
  return spent;
}

double total(const std::vector<double>& seconds) { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

/// A stage's CPU time on one thread and on two, which take turns.
struct Stage {
  double one = 0, two = 0;
  double first_thread_more = 0;  ///< CPU seconds of the first of two threads less those of the second

  void add_one(const std::vector<double>& seconds) { one += total(seconds); }
  void add_two(const std::vector<double>& seconds) {
    two += total(seconds);
    first_thread_more += seconds[0] - seconds[1];
  }
};

struct Arguments {
  std::string scene;
  std::vector<std::string> gather_overrides;
  std::int64_t light_paths = 2'500'000;
  int rounds = 3, width = 256;
};

std::unique_ptr<Integrator> make_gatherer(const Arguments& arguments) {
  std::vector<std::string> overrides = {"vpl.passes_per_set=0",
                                        fmt::format("vpl.light_paths={}", arguments.light_paths)};
  overrides.insert(overrides.end(), arguments.gather_overrides.begin(), arguments.gather_overrides.end());
  return make_integrator(read_method_options("slc", overrides));
}

void print_row(const char* name, const Stage& stage) {
  fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.1f} % |\n", name, stage.one, stage.two, stage.two / stage.one,
             100 * stage.first_thread_more / stage.two);
}

int run(int argc, char** argv) {
  CLI::App app(
      "CPU time of tracing, building and gathering with two threads against one, and what only one thread does");
  Arguments arguments;
  app.add_option("SCENE", arguments.scene, "Mitsuba scene file (.xml)")->required();
  app.add_option("--light-paths", arguments.light_paths, "Of the set")->capture_default_str();
  app.add_option("--rounds", arguments.rounds, "One thread and two in turns, so often")->capture_default_str();
  app.add_option("--width", arguments.width, "Image width")->capture_default_str();
  app.add_option("--set", arguments.gather_overrides, "Parameter of slc: key=value")->allow_extra_args(false);
  CLI11_PARSE(app, argc, argv);

  LoadOptions options;
  options.permissive = true;
  options.width = arguments.width;
  const Scene scene(load_scene(arguments.scene, options));
  Stage tracing, pairs, saoh, gathering;
  for (int round = -1; round < arguments.rounds; ++round)  // the first one meets memory that is not there yet
    for (const int threads : {1, 2}) {
      set_thread_count(threads);
      const auto add = [&](Stage& stage, const std::function<void()>& work) {
        const std::vector<double> seconds = measure_threads(work);
        if (round < 0) return;
        threads == 1 ? stage.add_one(seconds) : stage.add_two(seconds);
      };
      VplSet set;
      add(tracing,
          [&] { set = trace_vpls(scene, {.light_paths = arguments.light_paths, .max_bounces = 5, .lobes = {}}); });
      for (const BuilderEntry& builder : builder_registry()) {
        VplSet copy = set;
        LightTree tree;
        add(std::string_view(builder.name) == "pairs" ? pairs : saoh, [&] { tree = builder.build(std::move(copy)); });
      }
      const std::unique_ptr<Integrator> gatherer = make_gatherer(arguments);
      gatherer->prepare(scene, {.components = {.emission = false, .direct = false}});
      Film film(scene.camera().resolution(), {});
      gatherer->render_pass(0, film);  // traces and builds
      add(gathering, [&] { gatherer->render_pass(1, film); });
    }
  fmt::print("| {} light paths | CPU s, 1 thread | CPU s, 2 threads | ratio | first thread's more |\n",
             arguments.light_paths);
  fmt::print("| --- | ---: | ---: | ---: | ---: |\n");
  print_row("tracing", tracing);
  print_row("building, pairs", pairs);
  print_row("building, saoh", saoh);
  print_row("gathering", gathering);
  return 0;
}

}  // namespace
}  // namespace gradslc

int main(int argc, char** argv) { return gradslc::run_benchmark(gradslc::run, argc, argv); }
