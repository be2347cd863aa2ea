#include "core/parameters.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gradslc {
namespace {

enum class Shape : std::uint8_t { round, square };

struct Settings {
  bool fast = true;
  int count = 3;
  float ratio = 0.1f;
  Shape shape = Shape::square;

  void describe(ParameterVisitor& visitor) {
    visitor.boolean("fast", fast, "whether to hurry");
    visitor.integer("count", count, at_least(1), "rays", "how many");
    visitor.group("inner", "the rest", [&] {
      visitor.real("ratio", ratio, {0, 1}, "", "how much");
      visitor.choice("shape", shape, {"round", "square"}, "which");
    });
  }
};

/// Writes each parameter as text and then replaces it.
class Recorder final : public ParameterVisitor {
 public:
  using ParameterVisitor::choice;
  using ParameterVisitor::integer;
  using ParameterVisitor::real;
  void boolean(std::string_view name, bool& value, std::string_view) override {
    note(name, std::to_string(value));
    value = false;
  }
  void integer(std::string_view name, std::int64_t& value, Range range, std::string_view, std::string_view) override {
    note(name, std::to_string(value));
    integer_range = range;
    value = 7;
  }
  void real(std::string_view name, double& value, Range, std::string_view, std::string_view) override {
    real_value = value;
    note(name, "real");
    value = 0.3;
  }
  void choice(std::string_view name, std::size_t& index, const std::vector<std::string>& names,
              std::string_view) override {
    note(name, names.at(index));
    index = 0;
  }
  void group(std::string_view name, std::string_view, const std::function<void()>& body) override {
    note(name, "{");
    body();
    text += "}";
  }

  std::string text;
  Range integer_range;
  double real_value = 0;

 private:
  void note(std::string_view name, const std::string& value) { text += std::string(name) + "=" + value + " "; }
};

TEST(ParameterVisitor, ReadsAndWritesThroughOneDeclaration) {
  Settings settings;
  Recorder recorder;
  settings.describe(recorder);
  EXPECT_EQ(recorder.text, "fast=1 count=3 inner={ ratio=real shape=square }");
  EXPECT_FALSE(settings.fast);
  EXPECT_EQ(settings.count, 7);
  EXPECT_EQ(settings.ratio, 0.3f);
  EXPECT_EQ(settings.shape, Shape::round);
}

TEST(ParameterVisitor, IntegersStayWithinTheirType) {
  Settings settings;
  Recorder recorder;
  settings.describe(recorder);
  EXPECT_EQ(recorder.integer_range.lower, 1);
  EXPECT_EQ(recorder.integer_range.upper, 2147483647.0);
}

TEST(ShortestDouble, PrintsLikeTheFloatAndRoundsBack) {
  EXPECT_EQ(shortest_double(0.1f), 0.1);
  EXPECT_EQ(shortest_double(1e-30f), 1e-30);
  for (const float value : {0.0f, 1 / 3.0f, 16777216.0f, 3.4e38f, -0.7f})
    EXPECT_EQ(static_cast<float>(shortest_double(value)), value);
  Settings settings;
  Recorder recorder;
  settings.describe(recorder);
  EXPECT_EQ(recorder.real_value, 0.1);
}

}  // namespace
}  // namespace gradslc
