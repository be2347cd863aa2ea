#include "experiments/memory_check.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace gradslc {
namespace {

constexpr double k_gibibyte = 1024.0 * 1024 * 1024;

std::vector<PlannedRun> two_methods() {
  return {{"room", "small", {1e6, 2e6, 1 * k_gibibyte, 1 * k_gibibyte}},
          {"room", "large", {1e7, 2e7, 2 * k_gibibyte, 3 * k_gibibyte}}};
}

std::string refusal(const std::vector<PlannedRun>& runs, double available) {
  try {
    require_memory(runs, available);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.message();
  }
  return "";
}

TEST(MemoryCheck, MethodsInTurnsHoldTheirSetsTogether) {
  EXPECT_EQ(peak_bytes(two_methods()), 4 * k_gibibyte);
  EXPECT_EQ(peak_bytes({}), 0);
}

TEST(MemoryCheck, RefusesWhatDoesNotFitAndSaysWhatWould) {
  EXPECT_EQ(refusal(two_methods(), 4 * k_gibibyte), "");
  EXPECT_EQ(refusal(two_methods(), 2 * k_gibibyte),
            "method \"large\": 10000000 light paths beside the other methods need 4 GiB with 2 GiB available; 5000000 "
            "would fit");
}

TEST(MemoryCheck, RefusesMoreVplsThanHaveNumbers) {
  const std::vector<PlannedRun> run = {{"room", "large", {1e9, 4e9, k_gibibyte, k_gibibyte}}};
  EXPECT_EQ(
      refusal(run, 100 * k_gibibyte),
      "method \"large\": 1000000000 light paths need 4e+09 VPLs where 2147483647 can be numbered; 530000000 would "
      "fit");
}

TEST(MemoryCheck, MethodsWithoutVplsAlwaysFit) {
  EXPECT_EQ(refusal({{"room", "spt", {}}}, 1), "");
  EXPECT_EQ(refusal({}, 1), "");
}

}  // namespace
}  // namespace gradslc
