#include "samplers/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "core/hash.h"
#include "support/statistics.h"

namespace gradslc {

void PrintTo(const SamplerEntry& entry, std::ostream* stream) { *stream << entry.name; }

namespace {

constexpr std::uint64_t k_seed = 2024;
constexpr int k_streams = 1 << 17;

class EverySampler : public testing::TestWithParam<SamplerEntry> {
 protected:
  SampleStream stream(std::uint64_t stream, std::uint32_t sample = 0, std::uint64_t seed = k_seed) const {
    return {GetParam().kind, seed, stream, sample};
  }
};
INSTANTIATE_TEST_SUITE_P(Samplers, EverySampler,
                         testing::ValuesIn(sampler_registry().begin(), sampler_registry().end()),
                         [](const auto& sampler) { return std::string(sampler.param.name); });

std::size_t cell(double u, int cells) { return static_cast<std::size_t>(u * cells); }

TEST(SamplerRegistry, NamesEachSamplerOnce) {
  std::set<std::string> names;
  std::set<SamplerKind> kinds;
  for (const SamplerEntry& entry : sampler_registry()) names.insert(entry.name), kinds.insert(entry.kind);
  EXPECT_EQ(names, (std::set<std::string>{"independent", "sobol"}));
  EXPECT_EQ(kinds.size(), sampler_registry().size());
}

TEST(UnitFloat, IsBelowOneForAllBits) {
  EXPECT_LT(to_unit_float(0xffffffffu), 1);
  EXPECT_EQ(to_unit_float(0), 0);
}

// Over streams, with the sample fixed, numbers are independent draws. False alarm 0.1 % for each sampler.
TEST_P(EverySampler, IsUniform) {
  constexpr int cells = 256, side = 16;
  std::vector<double> one(cells), fine(cells), low_bits(cells), two(side * side);
  for (int i = 0; i < k_streams; ++i) {
    const SampleStream s = stream(static_cast<std::uint64_t>(i), 3);
    const float u = s.get1(Use::roulette);
    const double d = s.get1_double(Use::emitter, 2);
    const Vec2 v = s.get2(Use::direction, 1);
    for (const double value : {double{u}, d, double{v.x}, double{v.y}}) ASSERT_TRUE(value >= 0 && value < 1) << value;
    one[cell(u, cells)] += 1;
    fine[cell(d, cells)] += 1;
    low_bits[static_cast<std::uint32_t>(d * 0x1p32) & 255] += 1;
    two[cell(v.x, side) * side + cell(v.y, side)] += 1;
  }
  for (const auto* counts : {&one, &fine, &low_bits, &two})
    EXPECT_GT(chi_square_uniform(*counts).p_value, sidak(1e-3, 4));
}

// Numbers whose names differ in one thing only are independent: their joint histogram over streams is flat. False alarm
// 0.1 % for each sampler.
TEST_P(EverySampler, NamesThatDifferGiveIndependentNumbers) {
  struct Pair {
    const char* what;
    std::function<double(std::uint64_t)> first, second;
  };
  const auto number = [this](std::uint64_t i) { return stream(i, 5).get1_double(Use::lens); };
  const std::vector<Pair> pairs{
      {"uses", number, [this](std::uint64_t i) { return stream(i, 5).get1_double(Use::lobe); }},
      {"indices", number, [this](std::uint64_t i) { return stream(i, 5).get1_double(Use::lens, 1); }},
      {"seeds", number, [this](std::uint64_t i) { return stream(i, 5, k_seed + 1).get1_double(Use::lens); }},
      {"streams", number, [this](std::uint64_t i) { return stream(i + k_streams, 5).get1_double(Use::lens); }},
      {"neighbouring streams", [&](std::uint64_t i) { return number(2 * i); },
       [&](std::uint64_t i) { return number(2 * i + 1); }},
      {"seed and stream exchanged", [this](std::uint64_t i) { return stream(i + 7, 5, i).get1_double(Use::lens); },
       [this](std::uint64_t i) { return stream(i, 5, i + 7).get1_double(Use::lens); }},
      {"stream and its branch", number,
       [this](std::uint64_t i) { return stream(i, 5).branch(0).get1_double(Use::lens); }},
      {"branches", [this](std::uint64_t i) { return stream(i, 5).branch(0).get1_double(Use::lens); },
       [this](std::uint64_t i) { return stream(i, 5).branch(1).get1_double(Use::lens); }},
      {"branches' order", [this](std::uint64_t i) { return stream(i, 5).branch(0).branch(1).get1_double(Use::lens); },
       [this](std::uint64_t i) { return stream(i, 5).branch(1).branch(0).get1_double(Use::lens); }},
      {"branch and index", [this](std::uint64_t i) { return stream(i, 5).branch(1).get1_double(Use::lens); },
       [this](std::uint64_t i) { return stream(i, 5).get1_double(Use::lens, 1); }},
      {"branches of neighbouring streams",
       [this](std::uint64_t i) { return stream(2 * i, 5).branch(1).get1_double(Use::lens); },
       [this](std::uint64_t i) { return stream(2 * i + 1, 5).branch(0).get1_double(Use::lens); }},
      {"coordinates", [this](std::uint64_t i) { return stream(i, 5).get2(Use::lens).x; },
       [this](std::uint64_t i) { return stream(i, 5).get2(Use::lens).y; }},
  };
  constexpr int side = 16;
  for (const Pair& pair : pairs) {
    std::vector<double> counts(side * side);
    for (std::uint64_t i = 0; i < k_streams; ++i)
      counts[cell(pair.first(i), side) * side + cell(pair.second(i), side)] += 1;
    EXPECT_GT(chi_square_uniform(counts).p_value, sidak(1e-3, pairs.size())) << pair.what;
  }
}

// Two uses of one stream are paired at random over its samples: the mean of (u - 1/2)(v - 1/2) over n samples has
// expectation 0, and about the variance of independent pairs, 1/(144 n). For sobol it is up to twice that, since the
// numbers' first digits are exchanged within couples of samples only; unshuffled it would be 9 times as much (n = 16).
// False alarm 0.1 %.
TEST_P(EverySampler, UsesArePairedAtRandomOverTheSamplesOfAStream) {
  constexpr std::uint32_t samples = 16;
  Moments products, squares;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    double sum = 0;
    for (std::uint32_t k = 0; k < samples; ++k)
      sum += (stream(i, k).get1_double(Use::lens) - 0.5) * (stream(i, k).get1_double(Use::lobe) - 0.5);
    products.add(sum / samples);
  }
  EXPECT_GT(products.p_value(0), 1e-3);
  EXPECT_GT(products.variance() * 144 * samples, 0.8);
  EXPECT_LT(products.variance() * 144 * samples, 2);
}

// As many rays of one sample as there are branches: each number is uniform over them, and none comes twice.
TEST_P(EverySampler, BranchesOfOneSampleAreUniform) {
  constexpr int cells = 256;
  std::vector<double> counts(cells);
  std::set<double> numbers;
  const SampleStream parent = stream(11, 5);
  for (std::uint32_t i = 0; i < 1 << 14; ++i) {
    const double u = parent.branch(i).get1_double(Use::compensation);
    counts[cell(u, cells)] += 1;
    numbers.insert(u);
  }
  EXPECT_GT(chi_square_uniform(counts).p_value, 1e-3);
  EXPECT_GT(numbers.size(), (1u << 14) - 4);  // of 2^32: 0.03 pairs are expected
}

TEST_P(EverySampler, BranchesReplayTheSameBits) {
  const SampleStream parent = stream(11, 5);
  const double before = parent.get1_double(Use::lens);
  const SampleStream branch = parent.branch(3);
  EXPECT_EQ(parent.get1_double(Use::lens), before);
  EXPECT_EQ(branch.get2(Use::direction, 2), stream(11, 5).branch(3).get2(Use::direction, 2));
  EXPECT_EQ(branch.branch(0).get1(Use::lobe), stream(11, 5).branch(3).branch(0).get1(Use::lobe));
}

TEST_P(EverySampler, ReplaysTheSameBitsInAnyOrder) {
  std::vector<Vec2> first;
  for (std::uint32_t k = 0; k < 100; ++k) first.push_back(stream(k % 7, k).get2(Use::direction, k % 5));
  for (std::uint32_t k = 100; k-- > 0;) {
    EXPECT_EQ(stream(k % 7, k).get2(Use::direction, k % 5), first[k]);
    EXPECT_EQ(stream(k % 7, k).get1(Use::lobe),
              to_unit_float(static_cast<std::uint32_t>(stream(k % 7, k).get1_double(Use::lobe) * 0x1p32)));
    const auto [u, v] = stream(k % 7, k).get_choice(Use::direction, k % 5);
    EXPECT_EQ(u, stream(k % 7, k).get1_double(Use::direction, k % 5));
    EXPECT_EQ(v, first[k].y);
  }
}

/// A hash of many numbers: changes with any bit of any of them.
std::uint64_t digest(SamplerKind kind) {
  std::uint64_t hash = 0;
  const auto add = [&](double u) { hash = hash_combine(hash, static_cast<std::uint64_t>(u * 0x1p32)); };
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const SampleStream s(kind, i % 3, std::uint64_t{i} << 30, i * 977);
    add(s.get1(Use::pixel));
    const Vec2 v = s.get2(Use::group_offset, i);
    add(v.x);
    add(v.y);
    add(s.get1_double(Use::descent, ~i));
  }
  return hash;
}

// The numbers themselves, so that another compiler, an optimisation or a change of the hash is seen: results of all
// experiments depend on them.
TEST(KnownAnswers, AreTheSameBitsOnEveryPlatform) {
  const SampleStream independent(SamplerKind::independent, 1, 2, 3);
  EXPECT_EQ(independent.get1_double(Use::pixel) * 0x1p32, 3684279574);
  const SampleStream sobol(SamplerKind::sobol, 1, 2, 3);
  EXPECT_EQ(sobol.get1_double(Use::pixel) * 0x1p32, 2339278892);
  EXPECT_EQ(independent.branch(4).get1_double(Use::pixel) * 0x1p32, 3789421224);
  EXPECT_EQ(sobol.branch(4).get1_double(Use::pixel) * 0x1p32, 3932055937);
  EXPECT_EQ(digest(SamplerKind::independent), 2287617483813489342u);
  EXPECT_EQ(digest(SamplerKind::sobol), 4372437766412000392u);
}

bool one_point_per_elementary_interval(const std::vector<Vec2>& points) {
  for (std::size_t columns = 1; columns <= points.size(); columns *= 2) {
    const std::size_t rows = points.size() / columns;
    std::vector<bool> taken(points.size());
    for (const Vec2 p : points) {
      const std::size_t interval = cell(p.x, static_cast<int>(columns)) * rows + cell(p.y, static_cast<int>(rows));
      if (taken[interval]) return false;
      taken[interval] = true;
    }
  }
  return true;
}

std::vector<Vec2> points(SamplerKind kind, std::uint64_t stream, std::uint32_t first, std::uint32_t count, Use use) {
  std::vector<Vec2> result;
  for (std::uint32_t k = first; k < first + count; ++k)
    result.push_back(SampleStream(kind, k_seed, stream, k).get2(use, 1));
  return result;
}

// A ray that every sample sends is stratified over the samples, as numbers of the stream itself are.
TEST(SobolSampler, PairsOfABranchAreA02Sequence) {
  for (std::uint32_t branch = 0; branch < 20; ++branch) {
    std::vector<Vec2> of_branch;
    for (std::uint32_t k = 0; k < 256; ++k)
      of_branch.push_back(SampleStream(SamplerKind::sobol, k_seed, 1, k).branch(branch).get2(Use::compensation, 1));
    EXPECT_TRUE(one_point_per_elementary_interval(of_branch)) << branch;
  }
}

TEST(SobolSampler, PairsAreA02Sequence) {
  for (const Use use : {Use::pixel, Use::direction, Use::group_offset})
    for (std::uint64_t stream = 0; stream < 20; ++stream)
      for (std::uint32_t count = 1; count <= 1024; count *= 4)
        for (const std::uint32_t block : {0u, 1u, 13u})
          EXPECT_TRUE(one_point_per_elementary_interval(points(SamplerKind::sobol, stream, block * count, count, use)))
              << stream << " " << block << " " << count;
  EXPECT_FALSE(one_point_per_elementary_interval(points(SamplerKind::independent, 0, 0, 16, Use::pixel)));
  EXPECT_FALSE(one_point_per_elementary_interval(points(SamplerKind::sobol, 0, 8, 16, Use::pixel)));  // not aligned
}

TEST(SobolSampler, SingleNumbersAreStratified) {
  for (std::uint64_t stream = 0; stream < 20; ++stream)
    for (std::uint32_t count = 1; count <= 4096; count *= 8) {
      std::set<std::size_t> floats, doubles;
      for (std::uint32_t k = 0; k < count; ++k) {
        const SampleStream s(SamplerKind::sobol, k_seed, stream, 3 * count + k);
        floats.insert(cell(s.get1(Use::lobe), static_cast<int>(count)));
        doubles.insert(cell(s.get1_double(Use::emitter), static_cast<int>(count)));
      }
      EXPECT_EQ(floats.size(), count);
      EXPECT_EQ(doubles.size(), count);
    }
}

/// Variance over streams of the estimate of the integral of a smooth function from `count` points of each.
double smooth_variance(SamplerKind kind, std::uint32_t count) {
  Moments estimates;
  for (std::uint64_t stream = 0; stream < 2000; ++stream) {
    double sum = 0;
    for (const Vec2 p : points(kind, stream, 0, count, Use::direction)) sum += std::exp(double{p.x} * p.y);
    estimates.add(sum / count);
  }
  EXPECT_GT(estimates.p_value(1.3179021514544038), 1e-3);  // sum over n >= 0 of 1 / (n! (n+1)^2)
  return estimates.variance();
}

// Owen 1997: N^-3 log N for smooth functions of two variables, where independent points have N^-1 and a digital shift
// alone N^-2. From 16 to 256 points that is a factor near 4096/2.
TEST(SobolSampler, ConvergesAsFastAsOwenScramblingShould) {
  EXPECT_GT(smooth_variance(SamplerKind::sobol, 16) / smooth_variance(SamplerKind::sobol, 256), 1200);
  EXPECT_LT(smooth_variance(SamplerKind::independent, 16) / smooth_variance(SamplerKind::independent, 256), 25);
}

}  // namespace
}  // namespace gradslc
