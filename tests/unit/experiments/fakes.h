#pragma once
// Methods whose result, noise and speed are known, and a clock that only they move.

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/hash.h"
#include "experiments/experiment.h"
#include "experiments/makers.h"
#include "materials/plugins.h"
#include "scene/scene.h"

namespace gradslc::fakes {

/// The time of a test and the protocol of who did what.
struct World {
  Seconds now{100, 1000};
  std::vector<std::string> protocol;  ///< method names, one per pass
  Clock clock() {
    return [this] { return now; };
  }
  /// One second on the wall takes two of CPU: two threads.
  void spend(double seconds) { now += Seconds{seconds, 2 * seconds}; }
};

struct Speed {
  double prepare_seconds = 0, pass_seconds = 1, reconstruct_seconds = 0;
  double noise = 0;  ///< standard deviation of a pass's sample over its mean
  IntegratorTraits traits = {};
  double slow_pass_seconds = 0;  ///< of pass `slow_pass`, where not 0
  int slow_pass = -1;
};

/// What every fake method estimates.
inline Rgb truth(Pixel p) {
  const auto v = 1 + 0.25f * static_cast<float>(p.x) + 0.5f * static_cast<float>(p.y);
  return {v, 0.5f * v, 2 * v};
}

class FakeIntegrator final : public Integrator {
 public:
  FakeIntegrator(World& world, std::string name, Speed speed) : world_(world), name_(std::move(name)), speed_(speed) {}
  void describe(ParameterVisitor&) override {}
  void prepare(const Scene&, const RenderSettings& settings) override {
    seed_ = settings.seed;
    world_.spend(speed_.prepare_seconds);
  }
  void render_pass(std::uint32_t pass, Film& film) override {
    world_.protocol.push_back(name_);
    world_.spend(static_cast<int>(pass) == speed_.slow_pass ? speed_.slow_pass_seconds : speed_.pass_seconds);
    const Resolution resolution = film.resolution();
    const int half = static_cast<int>(pass % 2);
    for (int y = 0; y < resolution.height; ++y)
      for (int x = 0; x < resolution.width; ++x) {
        const Pixel pixel{x, y};
        // Uniform with variance 1.
        const float u = to_unit_float(static_cast<std::uint32_t>(hash_combine(seed_, pass, resolution.index(pixel))));
        film.half(half).primal.add(pixel,
                                   truth(pixel) * (1 + static_cast<float>(speed_.noise * std::sqrt(12)) * (u - 0.5f)));
      }
    film.close_set(half);
    rays_ += resolution.pixels();
  }
  IntegratorTraits traits() const override { return speed_.traits; }
  IntegratorStatistics statistics() const override { return {rays_, {{"fake_counter", 7}}}; }

 private:
  World& world_;
  std::string name_;
  Speed speed_;
  std::uint64_t seed_ = 0, rays_ = 0;
};

/// Returns the primal of both halves, after its time.
class FakeReconstruction final : public Reconstruction {
 public:
  FakeReconstruction(World& world, double seconds) : world_(world), seconds_(seconds) {}
  void describe(ParameterVisitor&) override {}
  ReconstructionResult reconstruct(const ReconstructionInput& input) const override {
    world_.spend(seconds_);
    return {input.combined.primal, {3, 1e-6, true}};
  }

 private:
  World& world_;
  double seconds_;
};

inline SceneDescription fake_description(Resolution resolution, float size) {
  SceneDescription description;
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}};
  mesh.triangles = {{0, 1, 2}};
  description.meshes.push_back(mesh);
  description.materials.push_back(make_diffuse(Texture(Rgb(0.5f))));
  description.camera = PerspectiveCamera(resolution, {0, 0, -3}, {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, 1, 1);
  return description;
}

inline Scene fake_scene(Resolution resolution = {6, 4}, float size = 1) {
  return Scene(fake_description(resolution, size));
}

/// Makes fakes by the methods' names; `spt`, which references use, is made by its integrator's name.
inline Makers makers(World& world, const std::map<std::string, Speed>& speeds, float scene_size = 1) {
  Makers result;
  result.integrator = [&world, speeds](const MethodPlan& method) {
    return std::make_unique<FakeIntegrator>(world, method.name, speeds.at(method.name));
  };
  result.reconstruction = [&world, speeds](const MethodPlan& method) -> std::unique_ptr<Reconstruction> {
    if (method.reconstruction == "none") return nullptr;
    return std::make_unique<FakeReconstruction>(world, speeds.at(method.name).reconstruct_seconds);
  };
  result.scene = [scene_size](const ScenePlan& plan) {
    return fake_scene({plan.width.value_or(6), plan.height.value_or(4)}, scene_size);
  };
  result.clock = world.clock();
  return result;
}

inline MethodPlan method(const std::string& name, const std::string& reconstruction = "none") {
  return {name, "fake", nlohmann::json::object(), reconstruction, nlohmann::json::object()};
}

/// A fresh folder that goes with its owner.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("gradslc_" + name + "_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace gradslc::fakes
