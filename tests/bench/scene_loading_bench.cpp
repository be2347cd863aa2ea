// Time to load the largest of the real scenes (geometry only), beside what cannot be avoided: reading its bytes and
// building the Embree tree. Run it with OMP_WAIT_POLICY=passive, as gradslc runs: OpenMP's idle threads otherwise spin
// while Embree's build.

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <filesystem>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "core/file.h"
#include "core/parallel.h"
#include "scene/loaders/loader.h"

namespace gradslc {
namespace {

const std::filesystem::path k_file = std::filesystem::path(GRADSLC_SHARED_DIR) / "scenes" / "house" / "scene_v0.6.xml";

/// Whether the scene is there; says so where it is not.
bool find_scene(benchmark::State& state) {
  if (std::filesystem::exists(k_file)) return true;
  state.SkipWithError((k_file.string() + " does not exist: see ../shared/scenes").c_str());
  return false;
}

/// The scene file with shapes and sensor alone: materials, textures and emitters have costs of their own.
std::string geometry_only() {
  pugi::xml_document document;
  document.load_file(k_file.c_str());
  pugi::xml_node scene = document.child("scene");
  for (const char* tag : {"bsdf", "emitter", "texture", "integrator"})
    while (scene.remove_child(tag)) {
    }
  for (pugi::xml_node shape : scene.children("shape"))
    for (const char* tag : {"ref", "bsdf", "emitter"})
      while (shape.remove_child(tag)) {
      }
  std::ostringstream text;
  document.save(text);
  return text.str();
}

SceneDescription load() { return load_scene_text(geometry_only(), k_file.string()); }

std::size_t read_all(const std::vector<std::filesystem::path>& files) {
  return parallel_sum<std::size_t>(files.size(), 1,
                                   [&](std::size_t i, std::size_t) { return read_file(files[i]).size(); });
}

/// Embree's tree over meshes in memory, with the settings of Scene.
void build_tree(const std::vector<TriangleMesh>& meshes) {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  for (const TriangleMesh& mesh : meshes) {
    if (mesh.triangles.empty()) continue;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Point3),
                                              mesh.positions.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(mesh.triangles[0]), mesh.triangles.size());
    std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<Point3*>(positions));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), static_cast<std::array<std::uint32_t, 3>*>(indices));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene);
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

void house_bytes(benchmark::State& state) {
  if (!find_scene(state)) return;
  const std::vector<std::filesystem::path> files = load().files;
  std::size_t bytes = 0;
  for ([[maybe_unused]] auto iteration : state) bytes = read_all(files);
  state.counters["megabytes"] = static_cast<double>(bytes) * 1e-6;
}

void house_tree(benchmark::State& state) {
  if (!find_scene(state)) return;
  const SceneDescription description = load();
  for ([[maybe_unused]] auto iteration : state) build_tree(description.meshes);
}

void house_bytes_and_tree(benchmark::State& state) {
  if (!find_scene(state)) return;
  const SceneDescription description = load();
  for ([[maybe_unused]] auto iteration : state) {
    benchmark::DoNotOptimize(read_all(description.files));
    build_tree(description.meshes);
  }
}

void house_description(benchmark::State& state) {
  if (!find_scene(state)) return;
  for ([[maybe_unused]] auto iteration : state) benchmark::DoNotOptimize(load().meshes.size());
}

void house_scene(benchmark::State& state) {
  if (!find_scene(state)) return;
  std::size_t triangles = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const Scene scene(load());
    triangles = scene.triangle_count();
    benchmark::DoNotOptimize(triangles);
  }
  state.counters["triangles"] = static_cast<double>(triangles);
}

void settings(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK(house_bytes)->Apply(settings);
BENCHMARK(house_tree)->Apply(settings);
BENCHMARK(house_bytes_and_tree)->Apply(settings);  // what house_scene may take twice of
BENCHMARK(house_description)->Apply(settings);     // files to meshes
BENCHMARK(house_scene)->Apply(settings);           // files to a scene ready to trace

}  // namespace
}  // namespace gradslc
