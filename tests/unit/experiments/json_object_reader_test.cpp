#include "experiments/json_object_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/parameter_list.h"
#include "experiments/parameter_writer.h"
#include "unit/experiments/config_fixture.h"

namespace gradslc {
namespace {

using fixtures::FakeIntegrator;
using nlohmann::json;

/// Reads `text` into `target` and returns what was wrong: "line:column pointer: message".
std::vector<std::string> read(FakeIntegrator& target, const std::string& text) {
  const JsonDocument document = JsonDocument::parse("a.json", text);
  Problems problems;
  JsonObjectReader reader(document, "", problems);
  target.describe(reader);
  reader.report_unknown_keys();
  std::vector<std::string> found;
  for (const Error& error : problems.all())
    found.push_back(std::to_string(error.where().line) + ":" + std::to_string(error.where().column) + " " +
                    error.where().pointer + ": " + error.message());
  return found;
}

TEST(JsonObjectReader, ReadsEveryKindOfParameter) {
  FakeIntegrator target;
  const auto problems = read(
      target, R"({"vpl": {"light_paths": 840000, "bounding": "clamp", "bound": 2}, "cut_size": 20, "roulette": true})");
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(target.light_paths, 840000);
  EXPECT_EQ(target.bounding, FakeIntegrator::Bounding::clamp);
  EXPECT_EQ(target.bound, 2.0f);
  EXPECT_EQ(target.cut_size, 20);
  EXPECT_TRUE(target.roulette);
}

TEST(JsonObjectReader, LeavesWhatIsNotGivenAtItsDefault) {
  FakeIntegrator target;
  EXPECT_TRUE(read(target, "{}").empty());
  EXPECT_EQ(target.light_paths, FakeIntegrator().light_paths);
  EXPECT_EQ(target.bound, FakeIntegrator().bound);
  EXPECT_EQ(target.bounding, FakeIntegrator().bounding);
}

TEST(JsonObjectReader, TakesIntegersInFloatingPointNotation) {
  for (const char* text : {"1e6", "1000000.0", "1000000"}) {
    FakeIntegrator target;
    EXPECT_TRUE(read(target, std::string(R"({"vpl": {"light_paths": )") + text + "}}").empty()) << text;
    EXPECT_EQ(target.light_paths, 1000000) << text;
  }
}

TEST(JsonObjectReader, SaysWhatIsWrongWithAValueAndLeavesTheDefault) {
  struct Case {
    const char *value, *message;
  };
  const Case integers[] = {
      {"0", "must be 1 to 1024 [nodes], not 0"},    {"1025", "must be 1 to 1024 [nodes], not 1025"},
      {"-4", "must be 1 to 1024 [nodes], not -4"},  {"1e30", "must be 1 to 1024 [nodes], not 1e+30"},
      {"2.5", "must be an integer, not 2.5"},       {"\"10\"", "must be an integer, not a string"},
      {"true", "must be an integer, not true"},     {"null", "must be an integer, not null"},
      {"[10]", "must be an integer, not an array"}, {"{}", "must be an integer, not an object"},
  };
  for (const Case& bad : integers) {
    FakeIntegrator target;
    const auto problems = read(target, std::string("{\"cut_size\":\n ") + bad.value + "}");
    ASSERT_EQ(problems.size(), 1u) << bad.value;
    EXPECT_EQ(problems[0], std::string("2:2 /cut_size: ") + bad.message);
    EXPECT_EQ(target.cut_size, FakeIntegrator().cut_size);
  }
  const Case in_group[] = {
      {R"("light_paths": 0)", "/vpl/light_paths: must be at least 1 [paths], not 0"},
      {R"("light_paths": 3e9)", "/vpl/light_paths: must be at most 2147483647 [paths], not 3000000000.0"},
      {R"("light_paths": 18446744073709551615)",
       "/vpl/light_paths: must be at most 2147483647 [paths], not 18446744073709551615"},
      {R"("bound": -1)", "/vpl/bound: must be at least 0 [1/length^2], not -1"},
      {R"("bound": 1e300)", "/vpl/bound: must be below 3.4e+38, not 1e+300"},
      {R"("bound": "1")", "/vpl/bound: must be a number, not a string"},
      {R"("bounding": "clmap")", "/vpl/bounding: \"clmap\" is unknown; did you mean \"clamp\"?"},
      {R"("bounding": 1)", "/vpl/bounding: must be a string, not 1"},
  };
  for (const Case& bad : in_group) {
    FakeIntegrator target;
    const auto problems = read(target, std::string(R"({"vpl": {)") + bad.value + "}}");
    ASSERT_EQ(problems.size(), 1u) << bad.value;
    EXPECT_EQ(problems[0].substr(problems[0].find('/')), bad.message);
    EXPECT_EQ(target.bound, FakeIntegrator().bound);
    EXPECT_EQ(target.light_paths, FakeIntegrator().light_paths);
    EXPECT_EQ(target.bounding, FakeIntegrator().bounding);
  }
}

TEST(JsonObjectReader, ReportsEveryProblemAtOnce) {
  FakeIntegrator target;
  const std::vector<std::string> expected = {
      "2:27 /vpl/light_paths: must be at least 1 [paths], not -1",
      "2:31 /vpl/lihgt: unknown key; known: light_paths, bounding, bound",
      "3:13 /cut_size: must be 1 to 1024 [nodes], not 0",
      "3:28 /roulette: must be true or false, not 1",
      "3:31 /cut_sise: unknown key; did you mean \"cut_size\"?",
  };
  EXPECT_EQ(read(target,
                 "{\n"
                 "  \"vpl\": {\"light_paths\":  -1, \"lihgt\": 3},\n"
                 "\"cut_size\": 0, \"roulette\": 1, \"cut_sise\": 4}"),
            expected);
}

TEST(JsonObjectReader, AGroupMustBeAnObject) {
  FakeIntegrator target;
  EXPECT_EQ(read(target, R"({"vpl": 7})"), std::vector<std::string>{"1:9 /vpl: must be an object, not 7"});
  EXPECT_EQ(read(target, "[]"), std::vector<std::string>{"1:1 : must be an object, not an array"});
}

TEST(JsonParameterWriter, WhatItWritesReadsBackAsTheSameValues) {
  FakeIntegrator original;
  original.light_paths = 840000;
  original.bounding = FakeIntegrator::Bounding::none;
  original.bound = 0.3f;
  original.roulette = true;
  JsonParameterWriter writer;
  original.describe(writer);
  EXPECT_EQ(writer.values(), json::parse(R"({"vpl": {"light_paths": 840000, "bounding": "none", "bound": 0.3},
                                             "cut_size": 10, "roulette": true})"));
  FakeIntegrator copy;
  EXPECT_TRUE(read(copy, writer.values().dump()).empty());
  EXPECT_EQ(copy.light_paths, original.light_paths);
  EXPECT_EQ(copy.bounding, original.bounding);
  EXPECT_EQ(copy.bound, original.bound);
  EXPECT_EQ(copy.roulette, original.roulette);
}

TEST(ParameterLister, ListsPathsDefaultsRangesAndUnits) {
  FakeIntegrator target;
  ParameterLister lister;
  target.describe(lister);
  const auto& parameters = lister.parameters();
  ASSERT_EQ(parameters.size(), 5u);
  EXPECT_EQ(parameters[0].path, "vpl.light_paths");
  EXPECT_EQ(allowed_values(parameters[0]), "at least 1 [paths]");
  EXPECT_EQ(allowed_values(parameters[1]), "none | clamp | compensate");
  EXPECT_EQ(parameters[1].default_value, "compensate");
  EXPECT_EQ(parameters[2].default_value.dump(), "0.1");
  EXPECT_EQ(parameters[3].path, "cut_size");
  EXPECT_EQ(allowed_values(parameters[3]), "1 to 1024 [nodes]");
  EXPECT_EQ(to_json(parameters[3]), json::parse(R"({"path": "cut_size", "type": "integer", "default": 10, "minimum": 1,
      "maximum": 1024, "unit": "nodes", "meaning": "nodes of a cut"})"));
  EXPECT_EQ(allowed_values(parameters[4]), "true | false");
}

}  // namespace
}  // namespace gradslc
