#include "experiments/json_document.h"

#include <gtest/gtest.h>

#include <string>

namespace gradslc {
namespace {

using nlohmann::json;

struct Refusal {
  int line = 0, column = 0;
  std::string message, what;
};

/// The Error that parsing `text` throws; empty message where it throws none.
Refusal refusal(const std::string& text) {
  try {
    JsonDocument::parse("a.json", text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return {error.where().line, error.where().column, error.message(), error.what()};
  }
  return {};
}

TEST(JsonDocument, HoldsTheValueWithCommentsLeftOut) {
  const JsonDocument document =
      JsonDocument::parse("a.json", "// heading\n{ \"a\": [1, /* two */ 2.5], // {\n \"b\": {\"c\": \"x//y\"} }\n");
  EXPECT_EQ(document.root(), json::parse(R"({"a": [1, 2.5], "b": {"c": "x//y"}})"));
}

TEST(JsonDocument, KnowsWhereKeysAndValuesStand) {
  const JsonDocument document = JsonDocument::parse("a.json",
                                                    "{\n"
                                                    "  \"a\": [10, {\"b\\\"\" : true}],  /* \" { */\n"
                                                    "  \"c/d~\": {}, \"e\" :\n"
                                                    "    null, \"f\": []\n"
                                                    "}");
  const auto expect_at = [](const SourcePosition& where, int line, int column) {
    EXPECT_EQ(where.line, line) << where.pointer;
    EXPECT_EQ(where.column, column) << where.pointer;
    EXPECT_EQ(where.file, "a.json");
  };
  expect_at(document.position(""), 1, 1);
  expect_at(document.position("/a"), 2, 8);
  expect_at(document.key_position("/a"), 2, 3);
  expect_at(document.position("/a/0"), 2, 9);
  expect_at(document.position("/a/1"), 2, 13);
  expect_at(document.position("/a/1/b\""), 2, 22);
  expect_at(document.key_position("/a/1/b\""), 2, 14);
  expect_at(document.position(join_pointer("", "c/d~")), 3, 11);
  expect_at(document.position("/e"), 4, 5);
  expect_at(document.key_position("/e"), 3, 15);
  expect_at(document.position("/f"), 4, 16);
  // What is missing is reported at what encloses it.
  expect_at(document.position("/a/1/missing/deep"), 2, 13);
  EXPECT_EQ(document.position("/e").excerpt, "    null, \"f\": []");
  EXPECT_EQ(document.position("/a/1/missing/deep").pointer, "/a/1/missing/deep");
}

TEST(JsonDocument, CountsColumnsInCharactersAndShowsTabsAsBlanks) {
  const JsonDocument document = JsonDocument::parse("a.json", "{\t\"\xc3\xa4\xe2\x82\xac\": 7 }");
  const SourcePosition where = document.position("/\xc3\xa4\xe2\x82\xac");
  EXPECT_EQ(where.column, 9);
  EXPECT_EQ(where.excerpt, "{ \"\xc3\xa4\xe2\x82\xac\": 7 }");
}

TEST(JsonDocument, SkipsAByteOrderMark) {
  const JsonDocument document = JsonDocument::parse("a.json", "\xef\xbb\xbf{\"a\": 1}");
  EXPECT_EQ(document.root().at("a"), 1);
  EXPECT_EQ(document.position("/a").column, 7);
  EXPECT_EQ(document.position("/a").excerpt, "{\"a\": 1}");
}

TEST(JsonDocument, SyntaxErrorsShowTheLineAndACaret) {
  const Refusal missing_comma = refusal("{ \"a\": 1\n  \"b\": 2 }");
  EXPECT_EQ(missing_comma.line, 2);
  EXPECT_TRUE(missing_comma.what.starts_with("a.json:2:")) << missing_comma.what;
  EXPECT_NE(missing_comma.what.find(": error: syntax error"), std::string::npos) << missing_comma.what;
  EXPECT_NE(missing_comma.what.find("\n    2 |   \"b\": 2 }\n"), std::string::npos) << missing_comma.what;
  EXPECT_EQ(missing_comma.what.back(), '^');
}

TEST(JsonDocument, RefusesWhatIsNotJson) {
  struct Case {
    const char* text;
    int line, column;
    const char* reason;
  };
  const Case cases[] = {
      {"", 1, 1, "unexpected end of input"},      {"{\"a\": 1", 1, 8, "unexpected end of input"},
      {"{\"a\": 1} x", 1, 10, "invalid literal"}, {"{\"a\": NaN}", 1, 7, "JSON has no NaN or infinity"},
      {"[\n -Infinity]", 2, 3, "invalid number"}, {"[1, 1e999]", 1, 9, "number overflow"},
      {"[\"\xff\"]", 1, 3, "ill-formed UTF-8"},   {"[\"\xc3\"]", 1, 4, "ill-formed UTF-8"},
      {"[1,]", 1, 4, "unexpected ']'"},           {"{'a': 1}", 1, 2, "invalid literal"},
      {"[1] /* open", 1, 12, "invalid comment"},
  };
  for (const Case& bad : cases) {
    const Refusal refused = refusal(bad.text);
    EXPECT_NE(refused.message.find(bad.reason), std::string::npos) << bad.text << ": " << refused.message;
    EXPECT_EQ(refused.line, bad.line) << bad.text;
    EXPECT_EQ(refused.column, bad.column) << bad.text;
    EXPECT_EQ(refused.message.find('\n'), std::string::npos) << bad.text;
  }
}

TEST(JsonDocument, ErrorsAreTextEvenWhereTheFileIsNot) {
  const std::string shown = refusal("[\"\xff\"]").what;
  EXPECT_NO_THROW(json(shown).dump()) << "ill-formed UTF-8 in the message";
  EXPECT_LT(refusal("[\"" + std::string(100000, 'x')).what.size(), 1000u);
}

TEST(JsonDocument, RefusesAKeyGivenTwice) {
  const Refusal refused = refusal("{ \"a\": {\"b\": 1,\n \"b\": 2} }");
  EXPECT_EQ(refused.line, 2);
  EXPECT_EQ(refused.column, 2);
  EXPECT_EQ(refused.message, "key is given twice, first on line 1");
  EXPECT_EQ(refusal("[{\"a\": 1}, {\"a\": 1}]").message, "");
  // The same key, written differently.
  EXPECT_EQ(refusal("{\"a\": 1, \"\\u0061\": 1}").column, 10);
}

TEST(JsonDocument, LimitsNesting) {
  const auto nested = [](int levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  EXPECT_EQ(refusal(nested(JsonDocument::k_max_nesting)).message, "");
  const Refusal refused = refusal(nested(JsonDocument::k_max_nesting + 1));
  EXPECT_EQ(refused.message, "nested deeper than 64 levels");
  EXPECT_EQ(refused.column, JsonDocument::k_max_nesting + 1);
  EXPECT_EQ(refusal(nested(1000000)).message, "nested deeper than 64 levels");
}

TEST(JsonDocument, AReplacedValueIsReportedAtItsOrigin) {
  JsonDocument document = JsonDocument::parse("a.json", "{ \"a\": {\"b\": [1, 2]} }");
  document.replace("/a/b/1", 5, "--set x");
  document.replace("/c/d", "new", "--set y");
  EXPECT_EQ(document.root(), json::parse(R"({"a": {"b": [1, 5]}, "c": {"d": "new"}})"));
  EXPECT_EQ(document.position("/a/b/1").file, "--set x");
  EXPECT_EQ(document.position("/a/b/1").line, 0);
  EXPECT_EQ(document.position("/a/b/1/below").file, "--set x");
  EXPECT_EQ(document.position("/a/b/0").file, "a.json");
  EXPECT_EQ(document.key_position("/c/d").file, "--set y");
  EXPECT_THROW(document.replace("/a/b/2", 0, "--set z"), Error);
  EXPECT_THROW(document.replace("/a/b/x", 0, "--set z"), Error);
  EXPECT_THROW(document.replace("/a/b/0/x", 0, "--set z"), Error);
  EXPECT_EQ(document.root(), json::parse(R"({"a": {"b": [1, 5]}, "c": {"d": "new"}})"));
}

}  // namespace
}  // namespace gradslc
