#include "experiments/results.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file.h"
#include "experiments/csv.h"
#include "fakes.h"

namespace gradslc {
namespace {

ResultRow sample_row() {
  ResultRow row;
  row.scene = "cornell, \"the\" box";
  row.method = "GradSLC\nl2";
  row.point = 2;
  row.repeat = 1;
  row.passes = 37;
  row.wall_seconds = 0.1 + 0.2;
  row.cpu_seconds = 1.0 / 3;
  row.prepare_seconds = 1e-9;
  row.render_seconds = 123456.789;
  row.reconstruct_seconds = 0.5;
  row.rays = 12345678901234567u;
  double value = 1.0 / 7;
  for (const MetricEntry& metric : metric_registry()) row.metrics.push_back({metric.name, value = -value / 3});
  row.target = 20;
  row.final = true;
  row.budget_miss = -0.01;
  row.vpl_light_relmse = 0.75;
  row.vpl_light_relmse_trimmed = 0.1;
  row.reference_noise = 1e-5;
  row.flags = {"biased", "one_set"};
  return row;
}

void expect_equal(const ResultRow& a, const ResultRow& b) {
  EXPECT_EQ(to_csv(std::vector{a}), to_csv(std::vector{b}));
  EXPECT_EQ(a.scene, b.scene);
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.wall_seconds, b.wall_seconds) << "every bit";
  EXPECT_EQ(a.rays, b.rays);
  EXPECT_EQ(a.flags, b.flags);
  EXPECT_EQ(a.metric("relmse"), b.metric("relmse"));
  EXPECT_EQ(a.primal_relmse, b.primal_relmse);
  EXPECT_EQ(a.vpl_light_relmse, b.vpl_light_relmse);
  EXPECT_EQ(a.vpl_light_relmse_trimmed, b.vpl_light_relmse_trimmed);
}

TEST(Results, CsvBeginsWithTheFixedColumns) {
  const std::string csv = to_csv({});
  EXPECT_EQ(csv.rfind("scene,method,point,repeat,passes,spp,wall_seconds,cpu_seconds,prepare_seconds,render_seconds,"
                      "reconstruct_seconds,rays,mse,relmse,relmse_trimmed,mape,smape,mean_bias",
                      0),
            0u);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1);
}

TEST(Results, SurviveTheFile) {
  const fakes::TemporaryFolder folder("results");
  ResultRow without_errors = sample_row();
  without_errors.metrics.clear();
  without_errors.budget_miss.reset();
  without_errors.flags.clear();
  const std::vector<ResultRow> rows = {sample_row(), without_errors};
  write_file_atomically(folder.path() / "r.csv", to_csv(rows));
  const std::vector<ResultRow> read = read_results(folder.path() / "r.csv");
  ASSERT_EQ(read.size(), 2u);
  expect_equal(read[0], rows[0]);
  expect_equal(read[1], rows[1]);
  EXPECT_FALSE(read[1].metric("mse").has_value());
}

TEST(Results, BrokenFilesAreNamedWithTheirLine) {
  const fakes::TemporaryFolder folder("broken_results");
  const std::filesystem::path file = folder.path() / "r.csv";
  const std::string good = to_csv(std::vector{sample_row()});
  const auto line_of_error = [&](const std::string& content) {
    write_file_atomically(file, content);
    try {
      read_results(file);
    } catch (const Error& error) {
      return error.where().line;
    }
    return -1;
  };
  EXPECT_EQ(line_of_error(good), -1);
  EXPECT_EQ(line_of_error(good + "a,b\n"), 4) << "the row before has a line end in a field";
  std::string wrong_number = to_csv(std::vector{sample_row()});
  wrong_number.replace(wrong_number.find(",37,"), 4, ",3x,");
  EXPECT_EQ(line_of_error(wrong_number), 2);
  EXPECT_EQ(line_of_error("scene,method\n"), 0) << "a column is missing";
  EXPECT_EQ(line_of_error(""), 0);
}

TEST(Csv, FieldsWithSpecialCharactersAreQuoted) {
  EXPECT_EQ(csv_field("plain"), "plain");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"x\""), "\"say \"\"x\"\"\"");
  const std::vector<CsvRecord> records = parse_csv("a,\"b,\"\"c\"\"\nd\"\r\n,last");
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0].fields, (std::vector<std::string>{"a", "b,\"c\"\nd"}));
  EXPECT_EQ(records[1].fields, (std::vector<std::string>{"", "last"}));
  EXPECT_EQ(records[1].line, 3);
}

}  // namespace
}  // namespace gradslc
