#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace gradslc {
namespace {

/// Sets the number of threads and puts it back.
class Threads {
 public:
  explicit Threads(int count) : before_(thread_count()) { set_thread_count(count); }
  ~Threads() { set_thread_count(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
};

TEST(ParallelFor, VisitsEachIndexOnce) {
  for (const int threads : {1, 2, 7}) {
    const Threads scope(threads);
    EXPECT_EQ(thread_count(), threads);
    for (const std::size_t count : {0u, 1u, 16u, 17u, 1000u}) {
      std::vector<std::atomic<int>> visits(count);
      parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
        EXPECT_TRUE(begin < end && end - begin <= 16 && begin % 16 == 0);
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
      });
      for (const auto& visit : visits) ASSERT_EQ(visit, 1);
    }
  }
}

TEST(ParallelFor, RethrowsAndBeginsNoNewChunks) {
  for (const int threads : {1, 2, 7}) {
    const Threads scope(threads);
    std::atomic<int> begun = 0;
    const auto body = [&](std::size_t begin, std::size_t) {
      ++begun;
      if (begin == 10) throw std::runtime_error("chunk 10");
    };
    try {
      parallel_for(100'000, 1, body);
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()), "chunk 10");
    }
    EXPECT_LT(begun, 100'000);
  }
}

TEST(ParallelSum, HasTheSameBitsForAnyNumberOfThreads) {
  const auto sum = [](int threads) {
    const Threads scope(threads);
    return parallel_sum<double>(100'003, 64, [](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i)
        part += std::sin(static_cast<double>(i)) * std::pow(10.0, static_cast<double>(i % 30) - 15);
      return part;
    });
  };
  const double one = sum(1);
  for (int repetition = 0; repetition < 5; ++repetition) {
    EXPECT_EQ(sum(2), one);
    EXPECT_EQ(sum(7), one);
  }
  EXPECT_EQ(parallel_sum<double>(0, 64, [](std::size_t, std::size_t) { return 1.0; }), 0);
}

TEST(SetThreadCount, ZeroMeansAllCores) {
  const Threads scope(0);
  EXPECT_GE(thread_count(), 1);
}

}  // namespace
}  // namespace gradslc
