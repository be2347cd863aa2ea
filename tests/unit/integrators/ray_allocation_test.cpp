#include "integrators/ray_allocation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace gradslc {
namespace {

/// What two pilot passes see in every pixel of a cell: value +- deviation, so that its sample variance is
/// 2 deviation^2, and rays that brought `brought` in both.
struct Cell {
  double value, deviation, brought;
};
using CellOf = std::function<Cell(Pixel)>;

RayAllocation allocation_of(Resolution resolution, const RayAllocationParameters& parameters, const CellOf& cell_of,
                            const std::vector<int>& order) {
  RayAllocation allocation(resolution, parameters);
  for (const int pass : order) {
    EXPECT_FALSE(allocation.has_pass(pass));
    for (std::size_t i = 0; i < resolution.pixels(); ++i) {
      const Pixel pixel = resolution.pixel(i);
      const Cell cell = cell_of(pixel);
      const double value = cell.value + (pass % 2 == 0 ? cell.deviation : -cell.deviation);
      allocation.add(pass, pixel, static_cast<float>(value), static_cast<float>(cell.brought));
    }
    allocation.finish_pass(pass);
    EXPECT_TRUE(allocation.has_pass(pass));
  }
  EXPECT_FALSE(allocation.closed());
  allocation.close();
  EXPECT_TRUE(allocation.closed());
  return allocation;
}

constexpr Resolution k_two_cells{16, 8};
constexpr Cell k_left{1, 0.2, 0.3}, k_right{2, 0.1, 0.1};
Cell left_and_right(Pixel p) { return p.x < 8 ? k_left : k_right; }

/// Relative variance and relative second moment of the rays of these two cells: values are relative to
/// I^2 + 0.01 mean(I)^2, and mean(I) = 1.5.
constexpr double k_scale[] = {1 + 0.01 * 1.5 * 1.5, 4 + 0.01 * 1.5 * 1.5};
constexpr double k_variance = (2 * 0.04 / k_scale[0] + 2 * 0.01 / k_scale[1]) / 2;
constexpr double k_moment[] = {0.09 / k_scale[0], 0.01 / k_scale[1]};

constexpr RayAllocationParameters k_wide{.pilot_passes = 2, .pass_cost = 5, .fewest = 1e-3f, .most = 1e3f};

TEST(RayAllocation, IsTheClosedForm) {
  const RayAllocation allocation = allocation_of(k_two_cells, k_wide, left_and_right, {0, 1});
  const double left = std::sqrt(k_moment[0] * 5 / k_variance), right = std::sqrt(k_moment[1] * 5 / k_variance);
  EXPECT_GT(left, 3);  // both roulette and splitting
  EXPECT_LT(right, 0.6);
  for (std::size_t i = 0; i < k_two_cells.pixels(); ++i) {
    const Pixel pixel = k_two_cells.pixel(i);
    EXPECT_NEAR(allocation.rays(pixel), pixel.x < 8 ? left : right, 1e-5) << pixel.x << "," << pixel.y;
  }
}

// The numbers are those of least error x time, (V + mean(m / n)) (C + mean(n)): more or fewer in either cell cost more.
TEST(RayAllocation, IsTheBestForTheTime) {
  const RayAllocation allocation = allocation_of(k_two_cells, k_wide, left_and_right, {0, 1});
  const std::array<double, 2> best = {static_cast<double>(allocation.rays({0, 0})),
                                      static_cast<double>(allocation.rays({8, 0}))};
  const auto cost = [](const std::array<double, 2>& n) {
    return (k_variance + (k_moment[0] / n[0] + k_moment[1] / n[1]) / 2) * (5 + (n[0] + n[1]) / 2);
  };
  for (const std::size_t cell : {0u, 1u})
    for (const double factor : {0.8, 0.95, 1.05, 1.25}) {
      std::array<double, 2> other = best;
      other[cell] *= factor;
      EXPECT_GT(cost(other), cost(best)) << cell << " " << factor;
    }
}

TEST(RayAllocation, IsClamped) {
  RayAllocationParameters parameters = k_wide;
  parameters.fewest = 0.75f, parameters.most = 2;
  const RayAllocation allocation = allocation_of(k_two_cells, parameters, left_and_right, {0, 1});
  EXPECT_EQ(allocation.rays({7, 7}), 2);
  EXPECT_EQ(allocation.rays({8, 7}), 0.75f);
}

TEST(RayAllocation, CellsThatRaysBringNothingToGetTheFewest) {
  const CellOf dark_right = [](Pixel p) { return p.x < 8 ? k_left : Cell{0, 0, 0}; };
  EXPECT_EQ(allocation_of(k_two_cells, k_wide, dark_right, {0, 1}).rays({8, 0}), k_wide.fewest);
}

// 12 x 10 pixels: cells of 64, 32, 16 and 8 pixels, each of which counts by its pixels.
TEST(RayAllocation, CellsAtTheBorderCountByTheirPixels) {
  constexpr Resolution k_resolution{12, 10};
  constexpr std::array<Cell, 4> k_cells = {{{1, 0.1, 0.2}, {2, 0.3, 0.5}, {3, 0.2, 0.1}, {4, 0.9, 2}}};
  constexpr std::array<double, 4> k_pixels = {64, 32, 16, 8};
  const auto index = [](Pixel p) { return static_cast<std::size_t>(p.y / 8 * 2 + p.x / 8); };
  const RayAllocation allocation =
      allocation_of(k_resolution, k_wide, [&](Pixel p) { return k_cells[index(p)]; }, {0, 1});

  double mean = 0;
  for (std::size_t c = 0; c < 4; ++c) mean += k_pixels[c] / 120 * k_cells[c].value;
  std::array<double, 4> scale;
  double variance = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    scale[c] = k_cells[c].value * k_cells[c].value + 0.01 * mean * mean;
    variance += k_pixels[c] / 120 * 2 * k_cells[c].deviation * k_cells[c].deviation / scale[c];
  }
  for (std::size_t i = 0; i < k_resolution.pixels(); ++i) {
    const Pixel pixel = k_resolution.pixel(i);
    const std::size_t c = index(pixel);
    const double moment = k_cells[c].brought * k_cells[c].brought / scale[c];
    EXPECT_NEAR(allocation.rays(pixel), std::sqrt(moment * 5 / variance), 1e-5) << pixel.x << "," << pixel.y;
  }
}

TEST(RayAllocation, IsAFunctionOfThePilotsInAnyOrder) {
  RayAllocationParameters parameters = k_wide;
  parameters.pilot_passes = 4;
  const RayAllocation in_order = allocation_of(k_two_cells, parameters, left_and_right, {0, 1, 2, 3});
  const RayAllocation another = allocation_of(k_two_cells, parameters, left_and_right, {3, 1, 0, 2});
  for (std::size_t i = 0; i < k_two_cells.pixels(); ++i)
    EXPECT_EQ(in_order.rays(k_two_cells.pixel(i)), another.rays(k_two_cells.pixel(i)));
}

// Nothing to weigh rays against: no light, no variance, or one pass, which shows none.
TEST(RayAllocation, IsOneRayWherePilotsShowNoVariance) {
  const auto expect_one = [](const RayAllocationParameters& parameters, const CellOf& cell_of,
                             const std::vector<int>& order) {
    const RayAllocation allocation = allocation_of(k_two_cells, parameters, cell_of, order);
    for (std::size_t i = 0; i < k_two_cells.pixels(); ++i) EXPECT_EQ(allocation.rays(k_two_cells.pixel(i)), 1);
  };
  const auto black = [](Pixel) { return Cell{0, 0, 0}; };
  expect_one(k_wide, black, {0, 1});
  expect_one(k_wide, [](Pixel) { return Cell{1, 0, 0.5}; }, {0, 1});
  RayAllocationParameters one_pass = k_wide;
  one_pass.pilot_passes = 1;
  expect_one(one_pass, left_and_right, {0});
  expect_one(one_pass, black, {0});
}

}  // namespace
}  // namespace gradslc
