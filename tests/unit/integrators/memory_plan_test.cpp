// What methods say ahead that they will hold in memory.

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "lighttree/light_tree.h"
#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

constexpr RenderSettings k_settings{.max_depth = 5};

const std::vector<Method>& vpl_methods() {
  static const std::vector<Method> k_methods = {
      {"vpl", "vpl", {}},         {"lightcuts", "lightcuts", {}},
      {"slc", "slc", {}},         {"slc tile", "slc", {{"gather", "tile"}}},
      {"gradslc", "gradslc", {}}, {"gradslc random replay", "gradslc", {{"shift", "random_replay"}}},
  };
  return k_methods;
}

Method with(Method method, const std::string& key, const ParameterValue& value) {
  method.parameters[key] = value;
  return method;
}

MemoryPlan plan(const Method& method, double light_paths, const Scene& scene) {
  return with(method, "vpl/light_paths", light_paths).make()->plan_memory(scene, k_settings);
}

TEST(MemoryPlan, MethodsWithoutVplsHaveNone) {
  const MemoryPlan plan = Method{"", "spt", {}}.make()->plan_memory(test_box({8, 8}), k_settings);
  EXPECT_EQ(plan.light_paths, 0);
  EXPECT_EQ(plan.vpls, 0);
  EXPECT_EQ(plan.resident_bytes, 0);
  EXPECT_EQ(plan.peak_bytes, 0);
}

TEST(MemoryPlan, EveryMethodWithVplsIsHere) {
  for (const IntegratorEntry& entry : integrator_registry()) {
    const std::string name = entry.name;
    bool found = name == "spt" || name == "gpt";
    for (const Method& method : vpl_methods()) found |= method.integrator == entry.name;
    EXPECT_TRUE(found) << entry.name;
  }
}

TEST(MemoryPlan, GrowsWithTheLightPathsAndBeyondThePilotInProportion) {
  const Scene scene = glossy_box({8, 8});
  for (const Method& method : vpl_methods()) {
    MemoryPlan before = plan(method, 1, scene);
    EXPECT_EQ(before.light_paths, 1);
    for (const double light_paths : {100.0, 1e4, 1e6, 1e9}) {
      const MemoryPlan now = plan(method, light_paths, scene);
      SCOPED_TRACE(method.label + " " + std::to_string(light_paths));
      EXPECT_EQ(now.light_paths, light_paths);
      EXPECT_GT(now.vpls, before.vpls);
      EXPECT_GT(now.resident_bytes, before.resident_bytes);
      EXPECT_GT(now.peak_bytes, before.peak_bytes);
      EXPECT_GE(now.peak_bytes, now.resident_bytes);
      if (light_paths > 1e4) {
        const double factor = light_paths / before.light_paths;
        EXPECT_NEAR(now.vpls / before.vpls, factor, 1e-9 * factor);
        EXPECT_NEAR(now.peak_bytes / before.peak_bytes, factor, 1e-9 * factor);
      }
      before = now;
    }
  }
}

TEST(MemoryPlan, AListOfVplsNeedsNoTree) {
  constexpr double k_light_paths = 1e6;
  const Scene scene = test_box({8, 8});
  const MemoryPlan list = plan(vpl_methods()[0], k_light_paths, scene);
  EXPECT_EQ(list.resident_bytes, list.vpls * sizeof(Vpl));
  EXPECT_EQ(list.peak_bytes, list.resident_bytes);
  for (std::size_t m = 1; m < vpl_methods().size(); ++m)
    for (std::size_t b = 0; b < builder_registry().size(); ++b) {
      const BuilderEntry& builder = builder_registry()[b];
      const MemoryPlan tree = plan(with(vpl_methods()[m], "builder", std::string(builder.name)), k_light_paths, scene);
      EXPECT_EQ(tree.vpls, list.vpls);
      EXPECT_EQ(tree.resident_bytes, builder.resident_bytes({list.vpls, 0})) << vpl_methods()[m].label;
      EXPECT_EQ(tree.peak_bytes, builder.peak_bytes({list.vpls, 0})) << vpl_methods()[m].label;
      EXPECT_GT(tree.resident_bytes, list.resident_bytes);
    }
}

// The plan comes from the pilot's paths, rendering from others: the standard deviation of the VPLs of 20000 paths is
// below 1 %.
TEST(MemoryPlan, IsWhatRenderingMakes) {
  constexpr double k_light_paths = 20000;
  const Scene scene = test_box({2, 2});
  const Method method = with({"", "slc", {}}, "vpl/light_paths", k_light_paths);
  const auto integrator = method.make();
  integrator->prepare(scene, k_settings);
  Film film(scene.camera().resolution(), {});
  integrator->render_pass(0, film);
  for (const auto& counter : integrator->statistics().counters) {
    if (counter.name == "vpls_per_set") {
      EXPECT_NEAR(integrator->plan_memory(scene, k_settings).vpls / counter.value, 1, 0.03);
    }
  }
}

TEST(MemoryPlan, FewerBouncesNeedLess) {
  const Scene scene = test_box({8, 8});
  for (const Method& method : vpl_methods()) {
    const MemoryPlan three = plan(method, 1e5, scene), one = plan(with(method, "vpl/max_bounces", 1.0), 1e5, scene);
    EXPECT_LT(one.peak_bytes, three.peak_bytes) << method.label;
  }
}

TEST(MemoryPlan, WithoutLightThereIsNothingToHold) {
  SceneDescription description;
  description.materials = {diffuse_material(Rgb(0.5f))};
  description.meshes = {inward_box({-1, -1, -1}, {1, 1, 1}, 0)};
  description.camera = camera_at({4, 4}, {0, 0, 0}, {0, 0, 1}, 60);
  const Scene scene(std::move(description));
  for (const Method& method : vpl_methods()) {
    const MemoryPlan none = plan(method, 1e9, scene);
    EXPECT_EQ(none.vpls, 0) << method.label;
    EXPECT_EQ(none.peak_bytes, 0) << method.label;
  }
}

}  // namespace
}  // namespace gradslc
