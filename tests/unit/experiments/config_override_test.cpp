#include "experiments/config_override.h"

#include <gtest/gtest.h>

namespace gradslc {
namespace {

using nlohmann::json;

JsonDocument overridden(const std::string& assignment) {
  JsonDocument document =
      JsonDocument::parse("a.json", R"({"seed": 1, "budget": {"spp": 4}, "methods": [{"name": "a"}, {"name": "b"}]})");
  apply_override(document, assignment);
  return document;
}

std::string refusal(const std::string& assignment) {
  try {
    overridden(assignment);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.what();
  }
  return "";
}

TEST(ConfigOverride, SetsByDottedPathOrPointer) {
  EXPECT_EQ(overridden("seed=7").root().at("seed"), 7);
  EXPECT_EQ(overridden("budget.spp=64").root().at("budget"), json::parse(R"({"spp": 64})"));
  EXPECT_EQ(overridden("/budget/spp=64").root().at("budget"), json::parse(R"({"spp": 64})"));
  EXPECT_EQ(overridden("methods.1.vpl.light_paths=1e5").root().at("methods").at(1),
            json::parse(R"({"name": "b", "vpl": {"light_paths": 1e5}})"));
}

TEST(ConfigOverride, TakesTheValueAsJsonWhereItIsJson) {
  EXPECT_EQ(overridden("budget={\"seconds\": 2}").root().at("budget"), json::parse(R"({"seconds": 2})"));
  EXPECT_EQ(overridden("sampler=sobol").root().at("sampler"), "sobol");
  EXPECT_EQ(overridden("sampler=\"7\"").root().at("sampler"), "7");
  EXPECT_EQ(overridden("name=a=b").root().at("name"), "a=b");
  EXPECT_EQ(overridden("name=").root().at("name"), "");
  EXPECT_EQ(overridden("parts=true").root().at("parts"), true);
}

TEST(ConfigOverride, RefusesWhatCannotBeSet) {
  EXPECT_EQ(refusal("seed"), "--set seed: error: must be key=value");
  EXPECT_EQ(refusal("=3"), "--set =3: error: must be key=value");
  EXPECT_EQ(refusal("/a~b=3"), "--set /a~b=3: error: \"/a~b\" is not a JSON pointer");
  EXPECT_EQ(refusal("methods.2.name=c"),
            "--set methods.2.name=c: error: /methods/2/name: \"2\" is not an element of an array of 2");
  EXPECT_EQ(refusal("seed.low=3"), "--set seed.low=3: error: /seed/low: \"low\" lies within 1, which has no keys");
  EXPECT_NE(refusal("a={\"b\": 1, \"b\": 2}").find("key is given twice"), std::string::npos);
}

}  // namespace
}  // namespace gradslc
