#include "core/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/random.h"

namespace gradslc {
namespace {

TEST(RadixSort, EqualsAStableSort) {
  TestRandom random(1);
  for (const std::size_t count : {0u, 1u, 2u, 1000u, 200000u}) {
    std::vector<SortRecord> records(count), scratch(count);
    for (std::size_t i = 0; i < count; ++i) records[i] = {random.bits() >> (random.below(4) * 16), i};
    auto expected = records;
    std::stable_sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    radix_sort(records, scratch);
    EXPECT_EQ(records, expected) << count;
  }
}

}  // namespace
}  // namespace gradslc
