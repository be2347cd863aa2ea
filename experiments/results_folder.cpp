#include "experiments/results_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/error.h"
#include "core/file.h"
#include "experiments/sha256.h"

namespace gradslc {
namespace {

constexpr const char* k_experiment_file = "experiment.json";

/// JSON pointer and both values of the first difference.
std::string first_difference(const nlohmann::json& there, const nlohmann::json& here) {
  const nlohmann::json difference = nlohmann::json::diff(there, here);
  const nlohmann::json::json_pointer pointer(difference.at(0).at("path").get<std::string>());
  const auto value = [&](const nlohmann::json& config) {
    return config.contains(pointer) ? config.at(pointer).dump() : std::string("absent");
  };
  return fmt::format("{} is {} there and {} now", pointer.to_string(), value(there), value(here));
}

}  // namespace

ResultsFolder::ResultsFolder(std::filesystem::path root, const Experiment& experiment) : root_(std::move(root)) {
  lock();
  try {
    claim(experiment);
  } catch (...) {
    close(lock_);
    throw;
  }
}

ResultsFolder::~ResultsFolder() { close(lock_); }

void ResultsFolder::lock() {
  std::error_code failure;
  std::filesystem::create_directories(root_, failure);
  if (failure) throw_input_error(root_.string(), "folder cannot be made: " + failure.message());
  const std::filesystem::path file = root_ / ".lock";
  lock_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) throw_input_error(root_.string(), fmt::format("folder cannot be written: {}", std::strerror(errno)));
  if (flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  close(lock_);
  if (reason == EWOULDBLOCK) {
    throw_failure(root_.string(), "another process is writing here; wait for it or choose another --out");
  }
  throw_failure(file.string(), fmt::format("cannot be locked: {}", std::strerror(reason)));
}

void ResultsFolder::claim(const Experiment& experiment) const {
  const std::filesystem::path file = root_ / k_experiment_file;
  if (!std::filesystem::exists(file)) {
    write_file_atomically(file, experiment.resolved.dump(2) + "\n");
    return;
  }
  const nlohmann::json there = nlohmann::json::parse(read_file(file), nullptr, false);
  if (there == experiment.resolved) return;
  const std::string difference = there.is_discarded() ? "" : ": " + first_difference(there, experiment.resolved);
  throw_input_error(root_.string(), "holds results of another config" + difference +
                                        "; choose another --out, or remove the folder to start anew");
}

std::filesystem::path ResultsFolder::run_folder(const std::string& scene, const std::string& method, int repeat) const {
  return run_path(root_, scene, method, repeat);
}

std::optional<std::vector<ResultRow>> ResultsFolder::complete_run(const std::string& scene,
                                                                  const std::string& scene_hash,
                                                                  const std::string& method, int repeat) const {
  const std::filesystem::path folder = run_folder(scene, method, repeat);
  const std::filesystem::path manifest_file = folder / "image.json";
  if (!std::filesystem::exists(manifest_file)) return std::nullopt;  // written last
  const nlohmann::json manifest = nlohmann::json::parse(read_file(manifest_file), nullptr, false);
  const auto made_from = nlohmann::json::json_pointer("/scene/content_sha256");
  if (manifest.value(made_from, "") != scene_hash) {
    throw_input_error(manifest_file.string(),
                      fmt::format("was made from another content of the scene {}; choose another --out, or remove {}",
                                  scene, folder.parent_path().parent_path().string()));
  }
  return read_results(folder / "convergence.csv");
}

std::string file_name_for(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                       c == '-' || (c == '.' && !result.empty());
    result += plain ? c : '_';
  }
  return result == name && !name.empty() ? result : result + '-' + sha256(name).substr(0, 8);
}

std::filesystem::path run_path(const std::filesystem::path& root, const std::string& scene, const std::string& method,
                               int repeat) {
  return root / "runs" / file_name_for(scene) / file_name_for(method) / fmt::format("repeat-{}", repeat);
}

}  // namespace gradslc
