// No pixel of a tile is short of light: with the same VPLs, camera rays and compensation rays, gathering by tiles has
// the mean of gathering from every VPL, pixel by pixel, on a scene whose tiles hold receivers that their neighbours do
// not stand for: thin poles and steps on a floor, corners, silhouettes.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

/// A floor with thin poles, steps and two walls under a lamp. The poles stand upright in the light of the floor, which
/// the floor around them does not get.
Scene poles_and_steps(Resolution resolution) {
  SceneDescription scene;
  scene.materials = {diffuse_material(Rgb(0.8f, 0.7f, 0.6f)), diffuse_material(Rgb(0.9f))};
  scene.meshes.push_back(quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 0));  // floor
  scene.meshes.push_back(quad({-2, 0, -2}, {4, 0, 0}, {0, 2, 0}, 0));  // back wall
  scene.meshes.push_back(quad({-2, 0, 2}, {0, 0, -4}, {0, 2, 0}, 0));  // left wall: a corner
  for (int i = 0; i < 7; ++i) {
    const float x = -1.5f + 0.5f * static_cast<float>(i), z = i % 2 == 0 ? 0.6f : -0.4f;
    scene.meshes.push_back(outward_box({x, 0, z}, {x + 0.03f, 0.35f, z + 0.03f}, 1));
  }
  for (int i = 0; i < 4; ++i) {
    const float height = 0.12f * static_cast<float>(i + 1);
    scene.meshes.push_back(outward_box({-0.8f, 0, -1 - 0.2f * static_cast<float>(i)},
                                       {0.9f, height, -0.8f - 0.2f * static_cast<float>(i)}, 0));
  }
  TriangleMesh lamp = quad({-0.4f, 1.9f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, 0);
  lamp.area_light = 0;
  scene.meshes.push_back(lamp);
  scene.area_lights.push_back({Rgb(10.0f)});
  scene.camera = camera_at(resolution, {0.4f, 1.1f, 2.6f}, {0, 0.15f, 0}, 60);
  return Scene(std::move(scene));
}

/// A vault with low fins along it, under a lamp. Each fin's light falls on the strips beside it alone, since the vault
/// curves away: there are more such places than a tile has representatives.
Scene vault_with_fins(Resolution resolution) {
  SceneDescription scene;
  scene.materials = {diffuse_material(Rgb(0.8f))};
  constexpr int k_strips = 60;
  constexpr float k_radius = 0.8f, k_fin = 0.02f, k_length = 2;
  const auto at = [](int strip, float radius) {
    const float angle = k_pi * static_cast<float>(strip) / k_strips;
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), -k_length / 2};
  };
  const Vec3 along{0, 0, k_length};
  for (int i = 0; i < k_strips; ++i) {
    const Vec3 first = at(i, k_radius), fin = at(i, k_radius + k_fin) - first;
    scene.meshes.push_back(quad(Point3() + first, along, at(i + 1, k_radius) - first, 0));
    scene.meshes.push_back(quad(Point3() + first, along, fin, 0));
    scene.meshes.push_back(quad(Point3() + first, fin, along, 0));
  }
  TriangleMesh lamp = quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, 0);
  lamp.area_light = 0;
  scene.meshes.push_back(lamp);
  scene.area_lights.push_back({Rgb(10.0f)});
  scene.camera = camera_at(resolution, {0, 2.6f, 2.2f}, {0, 0.4f, 0}, 45);
  return Scene(std::move(scene));
}

/// Smallest p-value over pixels of "the method has the mean of gathering from every VPL", Student's t over passes.
double smallest_p_value(const Scene& scene, const Method& method, std::uint32_t passes) {
  const RenderSettings settings{.seed = 11, .max_depth = 5, .components = {.emission = false, .direct = false}};
  Method every{"every VPL", "vpl", {}};
  for (const auto& [name, value] : method.parameters)
    if (name.starts_with("vpl/")) every.parameters[name] = value;
  const auto a = method.make(), b = every.make();
  a->prepare(scene, settings), b->prepare(scene, settings);
  const Resolution resolution = scene.camera().resolution();
  std::vector<Moments> differences(resolution.pixels());
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    Film film_a(resolution, {}), film_b(resolution, {});
    a->render_pass(pass, film_a), b->render_pass(pass, film_b);
    const RgbImage image_a = film_a.primal(), image_b = film_b.primal();
    for (std::size_t i = 0; i < differences.size(); ++i)
      differences[i].add(static_cast<double>(luminance(image_a[i])) - static_cast<double>(luminance(image_b[i])));
  }
  double smallest = 1;
  for (const Moments& m : differences) smallest = std::min(smallest, m.p_value(0));
  return smallest;
}

Method tile_method(double defensive, double cosine_floor, double size) {
  return {"slc tile",
          "slc",
          {{"gather", "tile"},
           {"tile/size", size},
           {"tile/candidates", 128.0},
           {"tile/samples", 16.0},
           {"tile/defensive", defensive},
           {"tile/cosine_floor", cosine_floor},
           {"effort/pilot_passes", 0.0},
           {"vpl/bound", 100.0},
           {"vpl/light_paths", 100.0}}};
}

// False-alarm rate 0.1 % over both sizes and all pixels.
TEST(TileGather, NoReceiverOfATileIsShortOfLight) {
  const Scene scene = poles_and_steps({40, 28});
  for (const double size : {7.0, 16.0})
    EXPECT_GT(smallest_p_value(scene, tile_method(0.1, 0.2, size), 400), sidak(0.001, 2 * 40 * 28)) << size;
}

// The same of vertices behind rays, which gather from the tile's candidates: with a small bound most light comes by
// them. Where every VPL is gathered from, paths go on there instead.
TEST(TileGather, NoVertexBehindARayIsShortOfLight) {
  const Scene scene = poles_and_steps({40, 28});
  Method method = tile_method(0.1, 0.2, 7);
  method.parameters["vpl/bound"] = 0.3;
  EXPECT_GT(smallest_p_value(scene, method, 400), sidak(0.001, 40 * 28));
}

// The same where a law of representatives alone is seen to fail; candidates drawn by power make up for it in part.
TEST(TileGather, NoPlaceThatOnlyItselfIsLitByAVplIsShortOfLight) {
  const Scene scene = vault_with_fins({28, 28});
  const double threshold = sidak(0.001, 28 * 28);
  EXPECT_GT(smallest_p_value(scene, tile_method(0.1, 0.2, 28), 3000), threshold);
  Method broken = tile_method(0, 0, 28);
  EXPECT_LT(smallest_p_value(scene, broken, 3000), threshold);
  broken.parameters["tile/power_share"] = 0.0;
  EXPECT_LT(smallest_p_value(scene, broken, 3000), 1e-9);
}

}  // namespace
}  // namespace gradslc
