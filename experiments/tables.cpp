#include "experiments/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <utility>

namespace gradslc {
namespace {

using Cell = std::function<std::string(const MethodSummary&)>;

std::string factor_cell(const std::optional<Factor>& factor, bool is_first, bool has_interval, Markup markup) {
  if (!factor) return "unknown";
  std::string value = format_number(factor->value, markup);
  if (is_first || !has_interval) return value;
  return value + (factor->significant ? "" : " (n.s.)");
}

/// A column of what was measured against the reference.
Cell error_cell(Estimate MethodSummary::Errors::*member, Markup markup) {
  return [=](const MethodSummary& method) {
    return method.errors ? format_estimate((*method.errors).*member, markup) : std::string();
  };
}

Cell factor_column(const SceneSummary& summary, Estimate MethodSummary::Errors::*member, Markup markup) {
  return [&summary, member, markup](const MethodSummary& method) {
    const MethodSummary& first = summary.methods.front();
    if (!method.errors || !first.errors) return std::string();
    const Estimate base = (*first.errors).*member, value = (*method.errors).*member;
    return factor_cell(improvement(base, value), &method == &first, base.count > 1 && value.count > 1, markup);
  };
}

std::string percent_of(double fraction, Markup markup) {
  return fmt::format("{:+.1f}{}", 100 * fraction, markup == Markup::latex ? "\\,\\%" : " %");
}

std::vector<std::pair<std::string, Cell>> table_columns(const SceneSummary& summary, Markup markup) {
  using Errors = MethodSummary::Errors;
  const auto any = [&](const auto& has) { return std::any_of(summary.methods.begin(), summary.methods.end(), has); };
  const auto text = [markup](const std::string& s) { return markup == Markup::latex ? latex_text(s) : s; };
  std::vector<std::pair<std::string, Cell>> columns;
  columns.emplace_back("method", [=](const MethodSummary& m) { return text(m.method); });
  if (any([](const MethodSummary& m) { return m.errors.has_value(); })) {
    columns.emplace_back("relmse", error_cell(&Errors::relmse, markup));
    columns.emplace_back("relmse trimmed", error_cell(&Errors::relmse_trimmed, markup));
    if (any([](const MethodSummary& m) { return m.errors && m.errors->primal_relmse; })) {
      columns.emplace_back("relmse of primal", [=](const MethodSummary& m) {
        return m.errors && m.errors->primal_relmse ? format_estimate(*m.errors->primal_relmse, markup)
                                                   : std::string("-");
      });
    }
    columns.emplace_back("mean bias", [=](const MethodSummary& m) {
      return m.errors ? format_percent(m.errors->mean_bias, markup) : std::string();
    });
  }
  columns.emplace_back("seconds", [=](const MethodSummary& m) { return format_estimate(m.seconds, markup); });
  if (summary.equal_time) {
    columns.emplace_back("off budget", [=](const MethodSummary& m) {
      return m.largest_budget_miss ? percent_of(*m.largest_budget_miss, markup) : std::string();
    });
  }
  columns.emplace_back("CPU seconds", [=](const MethodSummary& m) { return format_estimate(m.cpu_seconds, markup); });
  columns.emplace_back("passes", [=](const MethodSummary& m) { return format_estimate(m.passes, markup); });
  columns.emplace_back("rays", [=](const MethodSummary& m) { return format_estimate(m.rays, markup); });
  if (any([](const MethodSummary& m) { return m.errors.has_value(); })) {
    columns.emplace_back("relmse x s", error_cell(&Errors::inefficiency, markup));
    columns.emplace_back("factor", factor_column(summary, &Errors::inefficiency, markup));
    columns.emplace_back("factor trimmed", factor_column(summary, &Errors::inefficiency_trimmed, markup));
  }
  if (any([](const MethodSummary& m) { return m.errors && m.errors->vpl_light_trimmed; })) {
    columns.emplace_back("VPL light: relmse trimmed", [=](const MethodSummary& m) {
      return m.errors && m.errors->vpl_light_trimmed ? format_estimate(*m.errors->vpl_light_trimmed, markup)
                                                     : std::string("-");
    });
    columns.emplace_back("factor trimmed", [&summary, markup](const MethodSummary& m) {
      const MethodSummary& first = summary.methods.front();
      if (!m.errors || !m.errors->vpl_light_inefficiency || !first.errors || !first.errors->vpl_light_inefficiency)
        return std::string("-");
      const Estimate base = *first.errors->vpl_light_inefficiency, value = *m.errors->vpl_light_inefficiency;
      return factor_cell(improvement(base, value), &m == &first, base.count > 1 && value.count > 1, markup);
    });
  }
  columns.emplace_back("flags",
                       [=](const MethodSummary& m) { return text(fmt::format("{}", fmt::join(m.flags, ", "))); });
  return columns;
}

std::string markdown_cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

TextTable result_table(const SceneSummary& summary, Markup markup) {
  TextTable table;
  const auto columns = table_columns(summary, markup);
  for (const auto& [name, cell] : columns) table.header.push_back(name);
  for (const MethodSummary& method : summary.methods) {
    std::vector<std::string>& row = table.rows.emplace_back();
    for (const auto& [name, cell] : columns) row.push_back(cell(method));
  }
  return table;
}

std::string markdown_table(const TextTable& table) {
  std::string text;
  const auto add_line = [&](const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) text += fmt::format("| {} ", markdown_cell(cell));
    text += "|\n";
  };
  add_line(table.header);
  text += "| --- ";
  for (std::size_t i = 2; i < table.header.size(); ++i) text += "| ---: ";
  text += "| --- |\n";
  for (const std::vector<std::string>& row : table.rows) add_line(row);
  return text;
}

std::string latex_tables(std::span<const SceneSummary> summaries) {
  std::string text =
      "% needs \\usepackage{booktabs} and \\usepackage{graphicx}; intervals are 95 % (Student's t over repeats)\n";
  for (const SceneSummary& summary : summaries) {
    const TextTable table = result_table(summary, Markup::latex);
    text += "\\begin{table}\n  \\centering\n";
    text += fmt::format("  \\caption{{{}: {}.}}\n", latex_text(summary.scene),
                        summary.equal_time ? "equal time" : "equal samples");
    text += fmt::format("  \\resizebox{{\\linewidth}}{{!}}{{\\begin{{tabular}}{{l{}l}}\n    \\toprule\n",
                        std::string(table.header.size() - 2, 'r'));
    text += fmt::format("    {} \\\\\n    \\midrule\n", fmt::join(table.header, " & "));
    for (const std::vector<std::string>& row : table.rows) text += fmt::format("    {} \\\\\n", fmt::join(row, " & "));
    text += "    \\bottomrule\n  \\end{tabular}}\n\\end{table}\n";
  }
  return text;
}

std::string latex_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '\\':
        escaped += "\\textbackslash{}";
        break;
      case '~':
        escaped += "\\textasciitilde{}";
        break;
      case '^':
        escaped += "\\textasciicircum{}";
        break;
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}':
        escaped += '\\';
        [[fallthrough]];
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace gradslc
