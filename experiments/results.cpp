#include "experiments/results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>

#include "core/error.h"
#include "core/file.h"
#include "experiments/csv.h"

namespace gradslc {
namespace {

constexpr FlagEntry k_flags[] = {
    {"near_reference_noise", "its relmse is less than 3 times the reference's own: not known well"},
    {"imported_reference", "plain squares against an imported image: errors carry that image's noise"},
    {"biased", "the method's expectation is not the estimand"},
    {"truncated", "max_bounces cuts paths that max_depth allows: another estimand"},
    {"one_set", "one VPL set for the whole run: converges to that set's image"},
    {"budget_missed", "time differs from the budget by more than 2 % and by more than one pass"},
    {"invalid_samples", "samples that were not finite were left out"},
    {"not_converged", "the reconstruction's solver did not reach its residual"},
};

/// Value of a CSV field; false where the text is not one.
template <class Number>
bool parse(const std::string& text, Number& value) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size();
}
bool parse(const std::string& text, std::string& value) { return value = text, true; }
bool parse(const std::string& text, bool& value) {
  value = text == "1";
  return text == "0" || text == "1";
}
bool parse(const std::string& text, std::optional<double>& value) {
  value.reset();
  return text.empty() || parse(text, value.emplace());
}
bool parse(const std::string& text, std::vector<std::string>& value) {
  value.clear();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    value.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return true;
}

template <class Number>
std::string print(const Number& value) {
  return fmt::format("{}", value);
}
std::string print(const std::string& value) { return csv_field(value); }
std::string print(bool value) { return value ? "1" : "0"; }
std::string print(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; }
std::string print(const std::vector<std::string>& value) { return fmt::format("{}", fmt::join(value, " ")); }

struct Column {
  std::string name;
  std::function<std::string(const ResultRow&)> print;
  std::function<bool(ResultRow&, const std::string&)> parse;
  bool may_be_missing = false;  // in files of earlier versions
};

template <class Member>
Column column(std::string name, Member ResultRow::*member) {
  return {std::move(name), [member](const ResultRow& row) { return print(row.*member); },
          [member](ResultRow& row, const std::string& text) { return parse(text, row.*member); }};
}

Column metric_column(const std::string& name) {
  return {name, [name](const ResultRow& row) { return print(row.metric(name)); },
          [name](ResultRow& row, const std::string& text) {
            std::optional<double> value;
            if (!parse(text, value)) return false;
            if (value) row.metrics.push_back({name, *value});
            return true;
          }};
}

/// All columns in their order.
std::vector<Column> columns() {
  std::vector<Column> all = {column("scene", &ResultRow::scene),
                             column("method", &ResultRow::method),
                             column("point", &ResultRow::point),
                             column("repeat", &ResultRow::repeat),
                             column("passes", &ResultRow::passes),
                             column("spp", &ResultRow::passes),
                             column("wall_seconds", &ResultRow::wall_seconds),
                             column("cpu_seconds", &ResultRow::cpu_seconds),
                             column("prepare_seconds", &ResultRow::prepare_seconds),
                             column("render_seconds", &ResultRow::render_seconds),
                             column("reconstruct_seconds", &ResultRow::reconstruct_seconds),
                             column("rays", &ResultRow::rays)};
  for (const MetricEntry& metric : metric_registry()) all.push_back(metric_column(metric.name));
  all.push_back(column("target", &ResultRow::target));
  all.push_back(column("final", &ResultRow::final));
  all.push_back(column("budget_miss", &ResultRow::budget_miss));
  all.push_back(column("primal_relmse", &ResultRow::primal_relmse));
  for (auto [name, member] : {std::pair("vpl_light_relmse", &ResultRow::vpl_light_relmse),
                              {"vpl_light_relmse_trimmed", &ResultRow::vpl_light_relmse_trimmed}}) {
    all.push_back(column(name, member));
    all.back().may_be_missing = true;
  }
  all.push_back(column("reference_noise", &ResultRow::reference_noise));
  all.push_back(column("flags", &ResultRow::flags));
  return all;
}

}  // namespace

std::span<const FlagEntry> flag_registry() { return k_flags; }

bool ResultRow::has_flag(std::string_view flag) const {
  return std::find(flags.begin(), flags.end(), flag) != flags.end();
}

std::optional<double> ResultRow::metric(std::string_view name) const {
  for (const Metric& metric : metrics) {
    if (metric.name == name) return metric.value;
  }
  return std::nullopt;
}

std::string to_csv(std::span<const ResultRow> rows) {
  const std::vector<Column> all = columns();
  std::string text;
  const auto add_line = [&](const std::function<std::string(const Column&)>& field) {
    for (std::size_t c = 0; c < all.size(); ++c) text += fmt::format("{}{}", c == 0 ? "" : ",", field(all[c]));
    text += '\n';
  };
  add_line([](const Column& column) { return column.name; });
  for (const ResultRow& row : rows) add_line([&](const Column& column) { return column.print(row); });
  return text;
}

std::vector<ResultRow> read_results(const std::filesystem::path& file) {
  const std::vector<CsvRecord> records = parse_csv(read_file(file));
  if (records.empty()) throw_input_error(file.string(), "is empty; a header line is needed");
  const std::vector<std::string>& header = records[0].fields;

  std::vector<std::pair<std::size_t, Column>> found;
  for (Column& column : columns()) {
    const auto position = std::find(header.begin(), header.end(), column.name);
    if (position == header.end()) {
      if (column.may_be_missing) continue;
      throw_input_error(file.string(), fmt::format("has no column \"{}\"", column.name));
    }
    found.emplace_back(static_cast<std::size_t>(position - header.begin()), std::move(column));
  }
  std::vector<ResultRow> rows;
  for (const CsvRecord& record : std::span(records).subspan(1)) {
    SourcePosition where;
    where.file = file.string();
    where.line = record.line;
    if (record.fields.size() != header.size()) {
      throw_input_error(where, fmt::format("has {} fields, the header has {}", record.fields.size(), header.size()));
    }
    ResultRow& row = rows.emplace_back();
    for (const auto& [index, column] : found) {
      if (!column.parse(row, record.fields[index])) {
        throw_input_error(where,
                          fmt::format("\"{}\" is no value for the column {}", record.fields[index], column.name));
      }
    }
  }
  return rows;
}

}  // namespace gradslc
