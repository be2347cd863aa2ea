#include "core/error.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gradslc {
namespace {

TEST(Error, ShowsPositionMessageAndToken) {
  const Error error(Error::Kind::input,
                    {.file = "configs/cornell.json",
                     .line = 14,
                     .column = 43,
                     .pointer = "/methods/1/cut_sise",
                     .excerpt = R"(    { "name": "SLC", "integrator": "slc", "cut_sise": 10 })"},
                    "unknown key; did you mean \"cut_size\"?");
  EXPECT_EQ(std::string("\n") + error.what(), R"(
configs/cornell.json:14:43: error: /methods/1/cut_sise: unknown key; did you mean "cut_size"?
   14 |     { "name": "SLC", "integrator": "slc", "cut_sise": 10 }
      |                                           ^~~~~~~~~~)");
}

std::string underlined(const std::string& line, int column) {
  const Error error(Error::Kind::input, {.file = "f", .line = 1, .column = column, .pointer = {}, .excerpt = line},
                    "no");
  const std::string text = error.what();
  return text.substr(text.rfind('\n') + 1);
}

TEST(Error, UnderlinesTheTokenAtTheColumn) {
  EXPECT_EQ(underlined("spp: -1.5e+3, x", 6), "      |      ^~~~~~~");
  EXPECT_EQ(underlined("a } b", 3), "      |   ^");
  EXPECT_EQ(underlined("\t\tkey", 3), "      | \t\t^~~");
  EXPECT_EQ(underlined("\"\u00e9t\u00e9\": 1", 1), "      | ^~~~~");
  EXPECT_EQ(underlined("\u00e9: x", 5), "      |    ^");
  EXPECT_EQ(underlined("\u00e9: x", 2), "      |  ^");
  EXPECT_EQ(underlined("\"open", 1), "      | ^");
  EXPECT_EQ(underlined("ab", 3), "      |   ^");
  EXPECT_EQ(underlined("ab", 300), "      |   ^");
}

TEST(Error, ShowsNoMoreThanIsKnown) {
  const auto text = [](SourcePosition where) {
    return std::string(Error(Error::Kind::input, std::move(where), "no").what());
  };
  EXPECT_EQ(text({}), "error: no");
  EXPECT_EQ(text({.file = "a.xml", .pointer = {}, .excerpt = {}}), "a.xml: error: no");
  EXPECT_EQ(text({.file = "a.xml", .line = 3, .pointer = {}, .excerpt = {}}), "a.xml:3: error: no");
  EXPECT_EQ(text({.file = "a.xml", .column = 3, .pointer = "shape[2]", .excerpt = {}}), "a.xml: error: shape[2]: no");
  EXPECT_EQ(text({.file = "a.xml", .line = 3, .pointer = {}, .excerpt = "<x>"}), "a.xml:3: error: no\n    3 | <x>");
}

TEST(Error, SaysWhoseFaultItIs) {
  const auto kind = [](auto&& thrower) {
    try {
      thrower();
    } catch (const Error& error) {
      EXPECT_EQ(error.message(), "because");
      return error.kind();
    }
    throw std::logic_error("nothing was thrown");
  };
  EXPECT_EQ(kind([] { throw_input_error("f", "because"); }), Error::Kind::input);
  EXPECT_EQ(kind([] { throw_failure("f", "because"); }), Error::Kind::failure);
}

TEST(NearestName, FindsSlipsAndNothingElse) {
  const std::vector<std::string> names{"cut_size", "light_paths", "max_depth", "slc", "spt"};
  EXPECT_EQ(nearest_name("cut_sise", names), "cut_size");
  EXPECT_EQ(nearest_name("lightpaths", names), "light_paths");
  EXPECT_EQ(nearest_name("max_dpeth", names), "max_depth");
  EXPECT_EQ(nearest_name("slc", names), "slc");
  EXPECT_EQ(nearest_name("sppt", names), "spt");
  EXPECT_EQ(nearest_name("environment_map", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("slc", {}), "");
}

TEST(Suggestion, EndsTheMessage) {
  const std::vector<std::string> names{"slc", "spt"};
  EXPECT_EQ(suggestion("slcc", names), "; did you mean \"slc\"?");
  EXPECT_EQ(suggestion("photon_mapping", names), "; known: slc, spt");
}

}  // namespace
}  // namespace gradslc
