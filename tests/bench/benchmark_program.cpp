#include "bench/benchmark_program.h"

#include <fmt/format.h>

#include <optional>

#include "core/error.h"
#include "experiments/cli/process_environment.h"
#include "experiments/config_override.h"

namespace gradslc {

MethodPlan read_method_options(const std::string& integrator, const std::vector<std::string>& overrides) {
  JsonDocument document = JsonDocument::from_value("--set", nlohmann::json{{"integrator", integrator}});
  for (const std::string& assignment : overrides) apply_override(document, assignment);
  Problems problems;
  const std::optional<MethodPlan> method = read_method(document, "", all_registries(), problems);
  if (!method) throw Error(problems.all().front());
  return *method;
}

int run_benchmark(int (*run)(int argc, char** argv), int argc, char** argv) {
  set_process_environment(argv);
  try {
    return run(argc, argv);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}

}  // namespace gradslc
