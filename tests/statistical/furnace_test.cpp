// A closed furnace has a closed form: every path of D edges brings albedo^(D-1). Every integrator must return it, at
// every depth and for every component.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scene/loaders/loader.h"
#include "support/render/method.h"
#include "support/render/scenes.h"

namespace gradslc {
namespace {

const std::vector<Method>& methods() {
  static const std::vector<Method> k_methods = {
      {"spt", "spt", {}},
      {"spt with roulette", "spt", {{"roulette_depth", 2.0}}},
      {"vpl all", "vpl", {{"vpl/light_paths", 8.0}}},
      {"vpl uniform", "vpl", {{"vpl/light_paths", 50.0}, {"selection", "uniform"}}},
      {"vpl power", "vpl", {{"vpl/light_paths", 50.0}, {"selection", "power"}}},
      {"slc", "slc", {{"vpl/light_paths", 50.0}}},
      {"slc tile",
       "slc",
       {{"gather", "tile"}, {"tile/size", 4.0}, {"tile/candidates", 32.0}, {"vpl/light_paths", 50.0}}},
      {"slc, large bound", "slc", {{"vpl/light_paths", 50.0}, {"vpl/bound", 20.0}}},
      {"slc, bound below every connection", "slc", {{"vpl/light_paths", 50.0}, {"vpl/bound", 0.01}}},
      {"gradslc reconnection", "gradslc", {{"vpl/light_paths", 50.0}}},
      {"gradslc symmetric", "gradslc", {{"vpl/light_paths", 50.0}, {"stencil", "symmetric"}}},
      {"gradslc random replay", "gradslc", {{"vpl/light_paths", 50.0}, {"shift", "random_replay"}}},
      {"gradslc block", "gradslc", {{"vpl/light_paths", 50.0}, {"shift", "block"}, {"block/width", 3.0}}},
      {"gradslc block, tile",
       "gradslc",
       {{"vpl/light_paths", 50.0}, {"shift", "block"}, {"gather", "tile"}, {"tile/size", 8.0}}},
      {"gradslc reconnection, tile", "gradslc", {{"vpl/light_paths", 50.0}, {"gather", "tile"}, {"tile/size", 8.0}}},
      {"gradslc symmetric, tile",
       "gradslc",
       {{"vpl/light_paths", 50.0}, {"gather", "tile"}, {"tile/size", 8.0}, {"stencil", "symmetric"}}},
      {"gradslc random replay, tile",
       "gradslc",
       {{"vpl/light_paths", 50.0}, {"gather", "tile"}, {"tile/size", 4.0}, {"shift", "random_replay"}}},
      {"gpt", "gpt", {}},
  };
  return k_methods;
}

double furnace_radiance(double albedo, const Components& components, int max_depth) {
  double sum = 0;
  for (int edges = 1; edges <= max_depth; ++edges)
    if (components.includes(edges)) sum += std::pow(albedo, edges - 1);
  return sum;
}

/// False-alarm rate 0.1 % for the whole test.
void expect_furnace(const Components& components, int max_depth) {
  constexpr float k_albedo = 0.5f;
  const Scene scene = closed_furnace(Rgb(k_albedo), {16, 16});
  const double expected = furnace_radiance(k_albedo, components, max_depth);
  const double level = sidak(0.001, methods().size());
  for (const Method& method : methods()) {
    const auto moments = block_moments(method, scene, {.max_depth = max_depth, .components = components},
                                       {.runs = 240, .passes = 2, .block = 16, .seed = 11});
    const Moments& image = moments.blocks.at(Quantity::image)[0];
    EXPECT_GT(image.p_value(expected), level)
        << fmt::format("{}: mean {} +- {}, expected {}", method.label, image.mean(), image.standard_error(), expected);
    EXPECT_LT(image.standard_error(), 0.01 * expected) << method.label << ": too noisy to tell";
  }
}

TEST(ClosedFurnace, AllLight) { expect_furnace({}, 6); }
TEST(ClosedFurnace, IndirectLight) { expect_furnace({.emission = false, .direct = false}, 6); }
TEST(ClosedFurnace, DirectLight) { expect_furnace({.emission = false, .indirect = false}, 6); }
TEST(ClosedFurnace, ShallowestIndirectLight) { expect_furnace({}, 3); }

// With a bound so small that most light comes by compensation rays, each of the ways in which what they leave at a
// vertex is gathered - next-event estimation, candidates, the next ray - has a share of which an error of 2 % is seen.
TEST(ClosedFurnace, WhatCompensationRaysGatherFromATilesCandidates) {
  const Scene scene = closed_furnace(Rgb(0.5f), {16, 16});
  const Components indirect{.emission = false, .direct = false};
  const double expected = furnace_radiance(0.5, indirect, 6);
  const Method method{"slc tile",
                      "slc",
                      {{"gather", "tile"},
                       {"tile/size", 8.0},
                       {"tile/candidates", 32.0},
                       {"tile/samples", 2.0},
                       {"vpl/light_paths", 50.0},
                       {"vpl/bound", 0.02}}};
  const auto moments = block_moments(method, scene, {.max_depth = 6, .components = indirect},
                                     {.runs = 150, .passes = 16, .block = 16, .seed = 13});
  const Moments& image = moments.blocks.at(Quantity::image)[0];
  EXPECT_GT(image.p_value(expected), 0.001)
      << "mean " << image.mean() << " +- " << image.standard_error() << ", expected " << expected;
  EXPECT_LT(image.standard_error(), 0.001 * expected) << "too noisy to tell";
}

// A floor under an environment of radiance 1: albedo exactly, whatever share of the emitters' power the environment has
// (a lamp that shines away from the floor takes three quarters of it).
TEST(OpenFurnace, TheEnvironmentIsWeightedByItsShareOfPower) {
  constexpr float k_albedo = 0.5f;
  const Scene scene = open_furnace({16, 16});
  for (const Method& method : {Method{"spt", "spt", {}}, Method{"slc", "slc", {{"vpl/light_paths", 50.0}}}}) {
    const auto moments =
        block_moments(method, scene, {.max_depth = 3}, {.runs = 50, .passes = 16, .block = 16, .seed = 12});
    const Moments& image = moments.blocks.at(Quantity::image)[0];
    EXPECT_GT(image.p_value(double{k_albedo}), sidak(0.001, 2)) << method.label << " " << image.mean();
    EXPECT_LT(image.standard_error(), 0.01 * double{k_albedo}) << method.label << ": too noisy to tell";
  }
}

TEST(ClosedFurnace, ClampingLosesEnergy) {  // a control: bounding without compensation must be seen
  const Scene scene = closed_furnace(Rgb(0.5f), {16, 16});
  const Method method{"clamped", "slc", {{"vpl/light_paths", 50.0}, {"vpl/bounding", "clamp"}, {"vpl/bound", 0.5}}};
  const auto moments =
      block_moments(method, scene, {.max_depth = 6}, {.runs = 100, .passes = 2, .block = 16, .seed = 11});
  const Moments& image = moments.blocks.at(Quantity::image)[0];
  EXPECT_LT(image.p_value(furnace_radiance(0.5, {}, 6)), 1e-6) << image.mean();
}

}  // namespace
}  // namespace gradslc
