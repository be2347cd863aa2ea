#include "core/memory.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "core/bulk_vector.h"

namespace gradslc {
namespace {

TEST(Memory, AvailableIsReadFromTheSystem) {
  EXPECT_EQ(mem_available("MemTotal:  24 kB\nMemFree:  1 kB\nMemAvailable:   23 kB\nBuffers: 2 kB\n"), 23 * 1024.0);
  EXPECT_EQ(mem_available("MemTotal: 24 kB\n"), std::nullopt);
  EXPECT_EQ(mem_available("MemAvailable: many\n"), std::nullopt);
  EXPECT_GT(available_memory(), 0);
}

TEST(Memory, BytesAreShownInBinaryUnits) {
  EXPECT_EQ(format_bytes(12), "12 bytes");
  EXPECT_EQ(format_bytes(1536), "1.5 KiB");
  EXPECT_EQ(format_bytes(20.25 * 1024 * 1024 * 1024), "20.2 GiB");
}

TEST(BulkVector, IsAlignedAndKeepsItsElements) {
  for (const std::size_t count : {1u, 1000u, 3'000'000u}) {
    BulkVector<std::uint64_t> numbers(count);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(numbers.data()) % 64, 0u);
    for (std::size_t i = 0; i < count; ++i) numbers[i] = i;
    numbers.resize(2 * count);
    numbers.push_back(7);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(numbers[i], i);
    EXPECT_EQ(numbers.back(), 7u);
  }
  EXPECT_THROW(BulkVector<std::uint64_t>().reserve(std::size_t{1} << 60), std::exception);
}

}  // namespace
}  // namespace gradslc
