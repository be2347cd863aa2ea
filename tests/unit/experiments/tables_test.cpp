#include "experiments/tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/number_format.h"

namespace gradslc {
namespace {

ResultRow row(const std::string& method, int repeat, double relmse, double seconds) {
  ResultRow result;
  result.scene = "box";
  result.method = method;
  result.repeat = repeat;
  result.passes = 64;
  result.wall_seconds = seconds;
  result.rays = 1000000;
  for (const MetricEntry& metric : metric_registry()) result.metrics.push_back({metric.name, 0});
  for (Metric& metric : result.metrics) {
    if (metric.name == "relmse") metric.value = relmse;
    if (metric.name == "relmse_trimmed") metric.value = relmse / 2;
    if (metric.name == "mean_bias") metric.value = 0.01;
  }
  result.target = 10;
  result.final = true;
  result.budget_miss = seconds / 10 - 1;
  return result;
}

/// Two repeats of each method, ten seconds each: relmse 0.04 -+ 1 % and 0.01 -+ 1 %.
std::vector<ResultRow> clear_win() {
  return {row("SPT", 0, 0.0396, 10), row("Ours", 0, 0.0099, 10), row("SPT", 1, 0.0404, 10), row("Ours", 1, 0.0101, 10)};
}

std::string all_text(const SceneSummary& summary) {
  std::string text;
  for (const std::string& sentence : verdict(summary)) text += sentence + "\n";
  return text;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Summary, AveragesFinalPointsOverRepeats) {
  std::vector<ResultRow> rows = clear_win();
  rows.push_back(row("SPT", 0, 77, 1));
  rows.back().final = false;
  const std::vector<SceneSummary> scenes = summarise(rows);
  ASSERT_EQ(scenes.size(), 1u);
  ASSERT_EQ(scenes[0].methods.size(), 2u);
  EXPECT_EQ(scenes[0].methods[0].method, "SPT") << "in the order of the experiment";
  const MethodSummary& spt = scenes[0].methods[0];
  EXPECT_NEAR(spt.errors->relmse.mean, 0.04, 1e-12);
  EXPECT_NEAR(spt.errors->relmse.half_width, 12.7062 * 0.0004, 1e-7) << "t with one degree of freedom";
  EXPECT_NEAR(spt.errors->inefficiency.mean, 0.4, 1e-12);
  EXPECT_EQ(spt.passes.mean, 64);
  EXPECT_TRUE(scenes[0].equal_time);
}

TEST(Summary, InefficiencyIsTakenPerRepeat) {
  const std::vector<SceneSummary> scenes = summarise(std::vector{row("A", 0, 0.1, 10), row("A", 1, 0.2, 5)});
  EXPECT_NEAR(scenes[0].methods[0].errors->inefficiency.mean, 1, 1e-12);
  EXPECT_NEAR(scenes[0].methods[0].errors->inefficiency.half_width, 0, 1e-12) << "means alone would give 1.125";
}

TEST(Verdict, NamesTheWinnerTheFactorAndThatItIsSignificant) {
  const std::string text = all_text(summarise(clear_win())[0]);
  EXPECT_TRUE(contains(text, "Ours is best, 4.00 times better than SPT, and the 95 % intervals do not overlap"))
      << text;
}

TEST(Verdict, SaysWhereThereIsNoSignificantDifference) {
  const std::vector<ResultRow> rows = {row("SPT", 0, 0.01, 10), row("Ours", 0, 0.02, 10), row("SPT", 1, 0.04, 10),
                                       row("Ours", 1, 0.03, 10)};
  const SceneSummary summary = summarise(rows)[0];
  EXPECT_TRUE(contains(all_text(summary), "no significant difference")) << all_text(summary);
  const TextTable table = result_table(summary, Markup::text);
  EXPECT_TRUE(contains(markdown_table(table), "(n.s.)"));
  EXPECT_FALSE(contains(markdown_table(result_table(summarise(clear_win())[0], Markup::text)), "n.s."));
}

TEST(Verdict, OneRepeatHasNoInterval) {
  const std::string text = all_text(summarise(std::vector{row("SPT", 0, 0.04, 10), row("Ours", 0, 0.01, 10)})[0]);
  EXPECT_TRUE(contains(text, "one repeat, so no interval")) << text;
}

TEST(Verdict, FirstMethodIsComparedWithTheBestEvenWhenItIsThird) {
  std::vector<ResultRow> rows = clear_win();
  for (int repeat = 0; repeat < 2; ++repeat) rows.push_back(row("Second", repeat, 0.02 + 0.0002 * repeat, 10));
  const std::string text = all_text(summarise(rows)[0]);
  EXPECT_TRUE(contains(text, "times better than Second")) << text;
  EXPECT_TRUE(contains(text, "4.00 times better than SPT")) << text;
}

TEST(Verdict, ErrorBelowTheReferenceIsNotRanked) {
  std::vector<ResultRow> rows = clear_win();
  for (int repeat = 0; repeat < 2; ++repeat) rows.push_back(row("Tiny", repeat, -1e-5, 10));
  const SceneSummary summary = summarise(rows)[0];
  const std::string text = all_text(summary);
  EXPECT_TRUE(contains(text, "Ours is best")) << text;
  EXPECT_TRUE(contains(text, "below what the reference can tell: Tiny")) << text;
  EXPECT_TRUE(contains(markdown_table(result_table(summary, Markup::text)), "unknown"));
}

TEST(Verdict, SaysWhatSpeaksAgainstAMethod) {
  std::vector<ResultRow> rows = clear_win();
  rows[3].flags = {"biased"};
  EXPECT_TRUE(contains(all_text(summarise(rows)[0]), "Ours: biased (")) << "of any repeat";
}

TEST(Verdict, EqualPassesAreJudgedByErrorAndByTime) {
  std::vector<ResultRow> rows = {row("SPT", 0, 0.04, 1), row("Ours", 0, 0.01, 10)};
  for (ResultRow& r : rows) r.budget_miss.reset();
  const std::string text = all_text(summarise(rows)[0]);
  EXPECT_TRUE(contains(text, "At equal passes (relmse): Ours is best, 4.00")) << text;
  EXPECT_TRUE(contains(text, "For its time (relmse x seconds): SPT is best, 2.50")) << text;
}

TEST(Tables, FactorIsAgainstTheFirstMethod) {
  const TextTable table = result_table(summarise(clear_win())[0], Markup::text);
  const auto column = std::find(table.header.begin(), table.header.end(), "factor") - table.header.begin();
  EXPECT_EQ(table.rows[0][static_cast<std::size_t>(column)], "1.00");
  EXPECT_EQ(table.rows[1][static_cast<std::size_t>(column)], "4.00");
}

TEST(Tables, LeaveOutWhatWasNotMeasured) {
  std::vector<ResultRow> rows = clear_win();
  for (ResultRow& r : rows) r.metrics.clear();
  const TextTable table = result_table(summarise(rows)[0], Markup::text);
  EXPECT_EQ(std::count(table.header.begin(), table.header.end(), "relmse"), 0);
  EXPECT_EQ(std::count(table.header.begin(), table.header.end(), "seconds"), 1);
  EXPECT_EQ(table.rows[0].size(), table.header.size());
}

TEST(Tables, LatexIsBalancedAndEscaped) {
  std::vector<ResultRow> rows = clear_win();
  for (ResultRow& r : rows) r.scene = "a_b & 100%";
  const std::string text = latex_tables(summarise(rows));
  EXPECT_TRUE(contains(text, "a\\_b \\& 100\\%"));
  EXPECT_TRUE(contains(text, "\\toprule"));
  EXPECT_TRUE(contains(text, "\\pm"));
  const auto count = [&](char c) { return std::count(text.begin(), text.end(), c); };
  EXPECT_EQ(count('{'), count('}'));
  EXPECT_EQ(count('$') % 2, 0);
}

TEST(Tables, MarkdownEscapesBars) {
  EXPECT_EQ(markdown_table({{"a", "b"}, {{"x|y", "1"}}}), "| a | b |\n| --- | --- |\n| x\\|y | 1 |\n");
}

TEST(Numbers, ShowAsManyDigitsAsTheirIntervalDeserves) {
  EXPECT_EQ(format_estimate({0.012345, 0.00041, 3}, Markup::text), "0.01235 ± 0.00041");
  EXPECT_EQ(format_estimate({1.23456e-5, 4.1e-7, 3}, Markup::text), "(1.235 ± 0.041)e-05");
  EXPECT_EQ(format_estimate({1.23456e-5, 4.1e-7, 3}, Markup::latex), "$(1.235 \\pm 0.041) \\times 10^{-5}$");
  EXPECT_EQ(format_estimate({64, 0, 3}, Markup::text), "64");
  EXPECT_EQ(format_estimate({1503.5, 212, 3}, Markup::text), "1504 ± 212");
  EXPECT_EQ(format_estimate({0.0123, INFINITY, 1}, Markup::text), "0.01230");
  EXPECT_EQ(format_estimate({-0.002, 0.005, 2}, Markup::text), "-0.0020 ± 0.0050");
  EXPECT_EQ(format_estimate({0, 0, 2}, Markup::text), "0");
  EXPECT_EQ(format_estimate({2.5e8, 3e6, 2}, Markup::text), "(2.500 ± 0.030)e+08");
  EXPECT_EQ(format_percent({0.0012, 0.0003, 2}, Markup::text), "+0.120 ± 0.030 %");
  EXPECT_EQ(format_number(1.4159, Markup::text), "1.42");
  EXPECT_EQ(format_number(0.0751, Markup::text), "0.0751");
}

}  // namespace
}  // namespace gradslc
