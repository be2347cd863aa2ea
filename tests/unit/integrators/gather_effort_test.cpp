#include "integrators/gather_effort.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace gradslc {
namespace {

/// What two pilot passes see in every pixel of a cell: value +- deviation, so that its sample variance is
/// 2 deviation^2, rays that brought `brought` in both, next-event estimates +- `emitters`, and draws of variance
/// `draw`.
struct Cell {
  double value, deviation, brought, emitters = 0, draw = 0;
};
constexpr int k_pilot_draws = 10;
using CellOf = std::function<Cell(Pixel)>;

EffortAllocation allocation_of(Resolution resolution, const EffortParameters& parameters, const CellOf& cell_of,
                               const std::vector<int>& order) {
  EffortAllocation allocation(resolution, parameters, k_pilot_draws);
  for (const int pass : order) {
    EXPECT_FALSE(allocation.has_pass(pass));
    for (std::size_t i = 0; i < resolution.pixels(); ++i) {
      const Pixel pixel = resolution.pixel(i);
      const Cell cell = cell_of(pixel);
      const double sign = pass % 2 == 0 ? 1 : -1;
      allocation.add(pass, pixel,
                     {.total = static_cast<float>(cell.value + sign * cell.deviation),
                      .by_ray = static_cast<float>(cell.brought),
                      .by_emitters = static_cast<float>(1 + sign * cell.emitters),
                      .draw_variance = static_cast<float>(cell.draw)});
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

constexpr EffortParameters k_wide{.pilot_passes = 2, .pass_cost = 5, .fewest_rays = 1e-3f, .most_rays = 1e3f};

TEST(EffortAllocation, IsTheClosedForm) {
  const EffortAllocation allocation = allocation_of(k_two_cells, k_wide, left_and_right, {0, 1});
  const double left = std::sqrt(k_moment[0] * 5 / k_variance), right = std::sqrt(k_moment[1] * 5 / k_variance);
  EXPECT_GT(left, 3);  // both roulette and splitting
  EXPECT_LT(right, 0.6);
  for (std::size_t i = 0; i < k_two_cells.pixels(); ++i) {
    const Pixel pixel = k_two_cells.pixel(i);
    EXPECT_NEAR(allocation.effort(pixel).rays, pixel.x < 8 ? left : right, 1e-5) << pixel.x << "," << pixel.y;
  }
}

// The numbers are those of least error x time, (V + mean(m / n)) (C + mean(n)): more or fewer in either cell cost more.
TEST(EffortAllocation, IsTheBestForTheTime) {
  const EffortAllocation allocation = allocation_of(k_two_cells, k_wide, left_and_right, {0, 1});
  const std::array<double, 2> best = {static_cast<double>(allocation.effort({0, 0}).rays),
                                      static_cast<double>(allocation.effort({8, 0}).rays)};
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

// Next-event estimates count by their variance over passes, draws by what their scatter says.
TEST(EffortAllocation, EstimatesAndDrawsAreTheClosedFormRounded) {
  const CellOf cells = [](Pixel p) { return p.x < 8 ? Cell{1, 0.2, 0.3, 0.1, 0.9} : Cell{2, 0.1, 0.1, 0.01, 0.02}; };
  const EffortAllocation allocation = allocation_of(k_two_cells, k_wide, cells, {0, 1});
  const auto number = [](double of_one, int cell) {
    return static_cast<int>(std::lround(std::max(1.0, std::sqrt(of_one / k_scale[cell] * 5 / (0.2 * k_variance)))));
  };
  const GatherEffort left = allocation.effort({0, 0}), right = allocation.effort({8, 0});
  EXPECT_EQ(left.emitters, number(2 * 0.01, 0));
  EXPECT_GT(left.emitters, 2);
  EXPECT_EQ(right.emitters, 1);
  EXPECT_EQ(left.draws, number(0.9, 0));
  EXPECT_GT(left.draws, 10);
  EXPECT_EQ(right.draws, number(0.02, 1));
  EXPECT_LT(right.draws, 10);

  EffortParameters fixed = k_wide;
  fixed.adapt_draws = false, fixed.most_emitter_samples = 2;
  const GatherEffort limited = allocation_of(k_two_cells, fixed, cells, {0, 1}).effort({0, 0});
  EXPECT_EQ(limited.draws, k_pilot_draws);
  EXPECT_EQ(limited.emitters, 2);
}

TEST(EffortAllocation, IsClamped) {
  EffortParameters parameters = k_wide;
  parameters.fewest_rays = 0.75f, parameters.most_rays = 2;
  const EffortAllocation allocation = allocation_of(k_two_cells, parameters, left_and_right, {0, 1});
  EXPECT_EQ(allocation.effort({7, 7}).rays, 2);
  EXPECT_EQ(allocation.effort({8, 7}).rays, 0.75f);
}

TEST(EffortAllocation, CellsThatRaysBringNothingToGetTheFewest) {
  const CellOf dark_right = [](Pixel p) { return p.x < 8 ? k_left : Cell{0, 0, 0}; };
  EXPECT_EQ(allocation_of(k_two_cells, k_wide, dark_right, {0, 1}).effort({8, 0}).rays, k_wide.fewest_rays);
}

// 12 x 10 pixels: cells of 64, 32, 16 and 8 pixels, each of which counts by its pixels.
TEST(EffortAllocation, CellsAtTheBorderCountByTheirPixels) {
  constexpr Resolution k_resolution{12, 10};
  constexpr std::array<Cell, 4> k_cells = {{{1, 0.1, 0.2}, {2, 0.3, 0.5}, {3, 0.2, 0.1}, {4, 0.9, 2}}};
  constexpr std::array<double, 4> k_pixels = {64, 32, 16, 8};
  const auto index = [](Pixel p) { return static_cast<std::size_t>(p.y / 8 * 2 + p.x / 8); };
  const EffortAllocation allocation =
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
    EXPECT_NEAR(allocation.effort(pixel).rays, std::sqrt(moment * 5 / variance), 1e-5) << pixel.x << "," << pixel.y;
  }
}

TEST(EffortAllocation, IsAFunctionOfThePilotsInAnyOrder) {
  EffortParameters parameters = k_wide;
  parameters.pilot_passes = 4;
  const EffortAllocation in_order = allocation_of(k_two_cells, parameters, left_and_right, {0, 1, 2, 3});
  const EffortAllocation another = allocation_of(k_two_cells, parameters, left_and_right, {3, 1, 0, 2});
  for (std::size_t i = 0; i < k_two_cells.pixels(); ++i)
    EXPECT_EQ(in_order.effort(k_two_cells.pixel(i)).rays, another.effort(k_two_cells.pixel(i)).rays);
}

// Nothing to weigh rays against: no light, no variance, or one pass, which shows none.
TEST(EffortAllocation, IsThePilotsWhereTheseShowNoVariance) {
  const auto expect_one = [](const EffortParameters& parameters, const CellOf& cell_of, const std::vector<int>& order) {
    const EffortAllocation allocation = allocation_of(k_two_cells, parameters, cell_of, order);
    for (std::size_t i = 0; i < k_two_cells.pixels(); ++i) EXPECT_EQ(allocation.effort(k_two_cells.pixel(i)).rays, 1);
  };
  const auto black = [](Pixel) { return Cell{0, 0, 0}; };
  expect_one(k_wide, black, {0, 1});
  expect_one(k_wide, [](Pixel) { return Cell{1, 0, 0.5}; }, {0, 1});
  EffortParameters one_pass = k_wide;
  one_pass.pilot_passes = 1;
  expect_one(one_pass, left_and_right, {0});
  expect_one(one_pass, black, {0});
}

}  // namespace
}  // namespace gradslc
