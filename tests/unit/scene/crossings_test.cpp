// What passes along a ray through panes and masks (Scene::passage), and where a ray goes on behind them.

#include <gtest/gtest.h>

#include "scene_fixtures.h"
#include "support/random.h"

namespace gradslc {
namespace {

constexpr float k_mask = 0.6f;  // transmittance of the masks below
const MaterialPtr k_black = make_diffuse(Texture(Rgb()));

/// Opacity by the middle of the square: left of u = 0.5 opaque, right of it a quarter.
class HalfOpaque final : public TextureMap {
 public:
  Rgb eval(Vec2 uv) const override { return Rgb(uv.x < 0.5f ? 1.0f : 0.25f); }
  Vec2 gradient(Vec2) const override { return {0, 0}; }
  Rgb max_value() const override { return Rgb(1); }
  Rgb min_value() const override { return Rgb(0.25f); }
  std::size_t memory_bytes() const override { return 0; }
};

/// Squares of side 2 across the z axis, at z = 1, 2, 3 ..., one for each material.
Scene stack(const std::vector<MaterialPtr>& materials) {
  SceneDescription description;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    description.meshes.push_back(test::parallelogram({-1, -1, static_cast<float>(i) + 1}, {2, 0, 0}, {0, 2, 0}));
    description.meshes.back().material = static_cast<std::uint32_t>(i);
  }
  description.materials = materials;
  return Scene(std::move(description));
}

MaterialPtr mask(float transmittance, MaterialPtr nested = k_black) {
  return make_mask(Texture(Rgb(1 - transmittance)), std::move(nested));
}

Ray along_z(float length, float x = 0.25f) { return segment({x, 0.125f, 0}, {x, 0.125f, length}); }

TEST(Passage, MultipliesTransmittancesAndCountsCrossings) {
  const Scene scene =
      stack({mask(k_mask), make_thin_dielectric(1.5f), mask(k_mask), make_mask(Texture(Rgb()), k_black)});
  ASSERT_TRUE(scene.has_crossings());
  const float pane = 1 - 2 * 0.04f / 1.04f;
  const float expected[] = {1, k_mask, k_mask * pane, k_mask * pane * k_mask, k_mask * pane * k_mask};
  for (int crossings = 0; crossings <= 4; ++crossings) {
    const Passage passage = scene.passage(along_z(static_cast<float>(crossings) + 0.5f), 10);
    EXPECT_EQ(passage.crossings, crossings);
    EXPECT_NEAR(passage.transmittance.g, expected[crossings], 1e-6f);
    EXPECT_NEAR(passage.probability, crossings < 2 ? 1 : pane, 1e-6f) << "black masks scatter nothing";
  }
}

TEST(Passage, EndsAfterTheMostCrossings) {
  const Scene scene = stack({mask(k_mask), mask(k_mask), mask(k_mask)});
  for (int most = 0; most <= 4; ++most) {
    const Passage passage = scene.passage(along_z(5), most);
    EXPECT_EQ(is_black(passage.transmittance), most < 3) << most;
    EXPECT_LE(passage.crossings, most);
    EXPECT_LE(passage.rays, most + 2);
  }
}

// Packets of any size, whole or not, of rays in all directions, with and without crossings allowed.
TEST(Passage, OfManyRaysIsThatOfEach) {
  const Scene scene = stack({mask(k_mask), make_thin_dielectric(1.5f), make_diffuse(Texture(Rgb(0.5f))), mask(k_mask)});
  TestRandom random(5);
  int blocked = 0, crossed = 0;
  for (const std::size_t count : {0u, 1u, 3u, 15u, 16u, 17u, 32u, 50u})
    for (int round = 0; round < 50; ++round) {
      std::vector<Ray> rays;
      std::vector<int> most;
      const auto point = [&] { return Point3{3 * random.get1() - 1.5f, 3 * random.get1() - 1.5f, 5 * random.get1()}; };
      for (std::size_t i = 0; i < count; ++i) {
        rays.push_back(segment(point(), point()));
        most.push_back(static_cast<int>(random.below(4)));
      }
      std::vector<Passage> passages(count);
      scene.passages(rays, most, passages);
      for (std::size_t i = 0; i < count; ++i) {
        const Passage alone = scene.passage(rays[i], most[i]);
        EXPECT_EQ(passages[i].transmittance, alone.transmittance);
        EXPECT_EQ(passages[i].probability, alone.probability);
        EXPECT_EQ(passages[i].crossings, alone.crossings);
        EXPECT_EQ(passages[i].rays, alone.rays);
        blocked += is_black(alone.transmittance) ? 1 : 0;
        crossed += alone.crossings > 0 && !is_black(alone.transmittance) ? 1 : 0;
      }
    }
  EXPECT_GT(blocked, 500);
  EXPECT_GT(crossed, 500);
}

TEST(Passage, IsBlockedByWhatIsOpaque) {
  for (const auto& materials : {std::vector{k_black, mask(k_mask)}, std::vector{mask(k_mask), k_black},
                                std::vector{mask(k_mask), make_mask(Texture(Rgb(1)), k_black)},
                                std::vector{make_dielectric(1.5f), mask(k_mask)}}) {
    const Scene scene = stack(materials);
    EXPECT_TRUE(is_black(scene.passage(along_z(3), 10).transmittance));
    EXPECT_EQ(is_black(scene.passage(along_z(1.5f), 10).transmittance), !materials[0]->crosses());
    EXPECT_TRUE(scene.occluded(along_z(3)));
    EXPECT_TRUE(scene.occluded(along_z(1.5f))) << "what lets light pass is a surface, too";
  }
}

TEST(Passage, FollowsTheTextureOfAMask) {
  const MaterialPtr grey = make_diffuse(Texture(Rgb(0.5f)));
  const Scene scene = stack({make_mask(Texture(std::make_shared<HalfOpaque>()), make_two_sided(grey, grey))});
  EXPECT_TRUE(is_black(scene.passage(along_z(2, -0.5f), 10).transmittance));
  const Passage passage = scene.passage(along_z(2, 0.5f), 10);
  EXPECT_EQ(passage.transmittance, Rgb(0.75f));
  EXPECT_EQ(passage.crossings, 1);
  EXPECT_NEAR(passage.probability, 0.75f / (0.75f + 0.25f * 0.5f), 1e-6f);
}

TEST(Passage, OfPanesDependsOnTheAngleAndNotOnTheSense) {
  const Scene scene = stack({make_thin_dielectric(1.5f)});
  const Point3 a{-0.9f, 0, 0.8f}, b{0.9f, 0, 1.2f};  // 12.5 degrees above the pane
  const Passage there = scene.passage(segment(a, b), 10), back = scene.passage(segment(b, a), 10);
  EXPECT_NEAR(there.transmittance.g, back.transmittance.g, 1e-5f);
  EXPECT_LT(there.transmittance.g, 0.6f);
  const Vec3 direction = normalize(b - a);
  EXPECT_NEAR(scene.passage({a, direction}, 10).transmittance.g, there.transmittance.g, 1e-5f) << "rays without end";
}

TEST(Passage, WithoutCrossingsIsOcclusion) {
  const Scene scene = stack({k_black});
  EXPECT_FALSE(scene.has_crossings());
  EXPECT_EQ(scene.passage(along_z(0.5f), 10).transmittance, Rgb(1));
  EXPECT_TRUE(is_black(scene.passage(along_z(2), 10).transmittance));
  EXPECT_EQ(scene.passage(along_z(2), 10).rays, 1);
}

TEST(Passage, OnlyMaterialsInUseMakeCrossings) {
  SceneDescription description = test::describe({test::parallelogram({}, {1, 0, 0}, {0, 1, 0})});
  description.materials.push_back(make_thin_dielectric(1.5f));
  EXPECT_FALSE(Scene(std::move(description)).has_crossings());
}

// A ray that goes on behind a surface ends where the whole ray would have ended.
TEST(PassOn, KeepsTheEndOfTheRay) {
  const Scene scene = stack({mask(k_mask)});
  for (const Ray& ray :
       {Ray{{0.1f, 0.2f, 0}, normalize(Vec3{0.1f, 0.2f, 1}), 3}, Ray{{0.1f, 0.2f, 0}, {0.2f, 0.4f, 2}, 1}}) {
    const auto hit = scene.intersect(ray);
    ASSERT_TRUE(hit);
    const Ray rest = pass_on(ray, *hit);
    EXPECT_EQ(rest.direction, ray.direction);
    EXPECT_GT(rest.origin.z, 1);
    EXPECT_LT(length(rest.at(rest.max_distance) - ray.at(ray.max_distance)), 1e-5f);
    EXPECT_FALSE(scene.intersect(rest)) << "the same surface is not met again";
  }
  const Ray endless{{0.1f, 0.2f, 0}, {0, 0, 1}};
  EXPECT_EQ(pass_on(endless, *scene.intersect(endless)).max_distance, k_infinity);
}

// Panes 6e-5 apart, 10 units from the origin: each of them is crossed.
TEST(PassOn, MissesNoSurfaceCloseBehind) {
  SceneDescription description;
  constexpr float k_gap = 6e-5f;
  for (int i = 0; i < 4; ++i)
    description.meshes.push_back(
        test::parallelogram({-1, -1, 10 + static_cast<float>(i) * k_gap}, {2, 0.1f, 0}, {0, 2, 0}));
  description.materials = {mask(0.5f)};
  const Scene scene(std::move(description));
  test::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Point3 from{random.get1() - 0.5f, random.get1() - 0.5f, 9};
    const Passage passage = scene.passage(segment(from, {random.get1() - 0.5f, random.get1() - 0.5f, 11}), 10);
    ASSERT_EQ(passage.crossings, 4);
    ASSERT_EQ(passage.transmittance, Rgb(0.0625f));
  }
}

}  // namespace
}  // namespace gradslc
