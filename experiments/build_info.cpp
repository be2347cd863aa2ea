#include "experiments/build_info.h"

#include <OpenEXR/OpenEXRConfig.h>
#include <embree3/rtcore_config.h>
#include <fmt/core.h>
#include <omp.h>
#include <sys/resource.h>
#include <sys/utsname.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <string>

#include "build_stamp.h"
#include "core/parallel.h"

namespace gradslc {
namespace {

std::string processor_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string operating_system() {
  utsname system{};
  if (uname(&system) != 0) return "unknown";
  return fmt::format("{} {} {}", system.sysname, system.release, system.machine);
}

}  // namespace

nlohmann::json build_info() {
  nlohmann::json commit = nullptr, dirty = nullptr;
  if (k_git_commit[0] != '\0') commit = k_git_commit, dirty = k_git_dirty;
#ifdef __clang__
  const char* const compiler = "clang " __VERSION__;
#else
  const char* const compiler = "g++ " __VERSION__;
#endif
  return {{"git_commit", commit},
          {"git_dirty", dirty},
          {"compiler", compiler},
          {"build_type", k_build_type},
          {"flags", k_build_flags},
          {"libraries",
           {{"embree", RTC_VERSION_STRING},
            {"openexr", OPENEXR_VERSION_STRING},
            {"openmp", _OPENMP},
            {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
            {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                          NLOHMANN_JSON_VERSION_PATCH)}}}};
}

nlohmann::json machine_info() {
  std::array<double, 3> load{};
  const bool known = getloadavg(load.data(), 3) == 3;
  return {{"processor", processor_name()},
          {"cores", omp_get_num_procs()},
          {"threads", thread_count()},
          {"load_average", known ? nlohmann::json(load) : nlohmann::json(nullptr)},
          {"system", operating_system()}};
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace gradslc
