#include "experiments/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "experiments/number_format.h"

namespace gradslc {
namespace {

/// The element with the given name, added at the end where it is missing.
template <class Element>
Element& find_or_add(std::vector<Element>& elements, std::string Element::*name, const std::string& wanted) {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const Element& e) { return e.*name == wanted; });
  if (found != elements.end()) return *found;
  Element& added = elements.emplace_back();
  added.*name = wanted;
  return added;
}

struct MethodRows {
  std::string method;
  std::vector<const ResultRow*> rows;  // final ones, one per repeat
};
struct SceneRows {
  std::string scene;
  std::vector<MethodRows> methods;
};

std::vector<SceneRows> group(std::span<const ResultRow> rows) {
  std::vector<SceneRows> scenes;
  for (const ResultRow& row : rows) {
    if (!row.final) continue;
    SceneRows& scene = find_or_add(scenes, &SceneRows::scene, row.scene);
    find_or_add(scene.methods, &MethodRows::method, row.method).rows.push_back(&row);
  }
  return scenes;
}

template <class Value>
Estimate estimate_over(const std::vector<const ResultRow*>& rows, const Value& value) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const ResultRow* row : rows) values.push_back(value(*row));
  return estimate_mean(values);
}

std::optional<MethodSummary::Errors> summarise_errors(const std::vector<const ResultRow*>& rows) {
  const auto has = [&](const auto& value) {
    return std::all_of(rows.begin(), rows.end(), [&](const ResultRow* row) { return value(*row).has_value(); });
  };
  if (!has([](const ResultRow& row) { return row.metric("relmse"); })) return std::nullopt;
  const auto metric = [&](const char* name) {
    return estimate_over(rows, [&](const ResultRow& row) { return *row.metric(name); });
  };
  const auto inefficiency = [&](const char* name) {
    return estimate_over(rows, [&](const ResultRow& row) { return *row.metric(name) * row.wall_seconds; });
  };
  MethodSummary::Errors errors{metric("relmse"),
                               metric("relmse_trimmed"),
                               metric("mean_bias"),
                               inefficiency("relmse"),
                               inefficiency("relmse_trimmed"),
                               std::nullopt,
                               std::nullopt,
                               std::nullopt};
  if (has([](const ResultRow& row) { return row.primal_relmse; })) {
    errors.primal_relmse = estimate_over(rows, [](const ResultRow& row) { return *row.primal_relmse; });
  }
  if (has([](const ResultRow& row) { return row.vpl_light_relmse_trimmed; })) {
    errors.vpl_light_trimmed = estimate_over(rows, [](const ResultRow& row) { return *row.vpl_light_relmse_trimmed; });
    errors.vpl_light_inefficiency =
        estimate_over(rows, [](const ResultRow& row) { return *row.vpl_light_relmse_trimmed * row.wall_seconds; });
  }
  return errors;
}

MethodSummary summarise_method(const MethodRows& group) {
  const std::vector<const ResultRow*>& rows = group.rows;
  MethodSummary summary;
  summary.method = group.method;
  summary.seconds = estimate_over(rows, [](const ResultRow& row) { return row.wall_seconds; });
  summary.cpu_seconds = estimate_over(rows, [](const ResultRow& row) { return row.cpu_seconds; });
  summary.passes = estimate_over(rows, [](const ResultRow& row) { return row.passes; });
  summary.rays = estimate_over(rows, [](const ResultRow& row) { return static_cast<double>(row.rays); });
  for (const ResultRow* row : rows) {
    if (!row->budget_miss) continue;
    double& largest =
        summary.largest_budget_miss ? *summary.largest_budget_miss : summary.largest_budget_miss.emplace(0);
    if (std::abs(*row->budget_miss) >= std::abs(largest)) largest = *row->budget_miss;
  }
  summary.errors = summarise_errors(rows);
  for (const FlagEntry& flag : flag_registry()) {
    if (std::any_of(rows.begin(), rows.end(), [&](const ResultRow* row) { return row->has_flag(flag.name); })) {
      summary.flags.emplace_back(flag.name);
    }
  }
  return summary;
}

/// One measure of the methods' errors that they are ranked by.
struct Measure {
  std::string name;
  Estimate MethodSummary::Errors::*value;
};

std::string significance(const Estimate& a, const Estimate& b) {
  if (a.count < 2 || b.count < 2) return "one repeat, so no interval says how sure this is";
  return intervals_overlap(a, b) ? "but the 95 % intervals overlap: no significant difference"
                                 : "and the 95 % intervals do not overlap";
}

std::string factor_text(const Estimate& smaller, const Estimate& larger) {
  return format_number(larger.mean / smaller.mean, Markup::text);
}

std::string sentence(const SceneSummary& summary, const Measure& measure) {
  std::vector<const MethodSummary*> ranked;
  std::vector<std::string> unknown;
  for (const MethodSummary& method : summary.methods) {
    if (method.errors && ((*method.errors).*measure.value).mean > 0)
      ranked.push_back(&method);
    else
      unknown.push_back(method.method);
  }
  const auto value = [&](const MethodSummary& method) { return (*method.errors).*measure.value; };
  std::stable_sort(ranked.begin(), ranked.end(),
                   [&](const MethodSummary* a, const MethodSummary* b) { return value(*a).mean < value(*b).mean; });
  std::string text = measure.name + ": ";
  if (ranked.size() < 2) {
    text += "nothing to compare";
  } else {
    const MethodSummary &best = *ranked[0], &second = *ranked[1], &first = summary.methods.front();
    text += fmt::format("{} is best, {} times better than {}, {}", best.method, factor_text(value(best), value(second)),
                        second.method, significance(value(best), value(second)));
    const bool first_is_ranked = std::find(ranked.begin(), ranked.end(), &first) != ranked.end();
    if (first_is_ranked && &first != &best && &first != &second) {
      text += fmt::format("; {} times better than {}, {}", factor_text(value(best), value(first)), first.method,
                          significance(value(best), value(first)));
    }
  }
  if (!unknown.empty()) {
    text += fmt::format("; not ranked, since their error is below what the reference can tell: {}",
                        fmt::join(unknown, ", "));
  }
  return text + ".";
}

}  // namespace

std::vector<SceneSummary> summarise(std::span<const ResultRow> rows) {
  std::vector<SceneSummary> summaries;
  for (const SceneRows& scene : group(rows)) {
    SceneSummary& summary = summaries.emplace_back();
    summary.scene = scene.scene;
    for (const MethodRows& method : scene.methods) summary.methods.push_back(summarise_method(method));
    summary.equal_time = summary.methods.front().largest_budget_miss.has_value();
  }
  return summaries;
}

std::optional<Factor> improvement(const Estimate& first, const Estimate& other) {
  if (!(first.mean > 0) || !(other.mean > 0)) return std::nullopt;
  return Factor{first.mean / other.mean, !intervals_overlap(first, other)};
}

std::vector<std::string> verdict(const SceneSummary& summary) {
  const bool measured = std::any_of(summary.methods.begin(), summary.methods.end(),
                                    [](const MethodSummary& method) { return method.errors.has_value(); });
  if (!measured) return {"No reference, so no errors were measured."};
  std::vector<Measure> measures;
  if (!summary.equal_time) {
    measures.push_back({"At equal passes (relmse)", &MethodSummary::Errors::relmse});
  }
  measures.push_back({"For its time (relmse x seconds)", &MethodSummary::Errors::inefficiency});
  measures.push_back({"Without the worst 0.1 % of the pixels (relmse_trimmed x seconds)",
                      &MethodSummary::Errors::inefficiency_trimmed});
  std::vector<std::string> sentences;
  sentences.reserve(measures.size());
  for (const Measure& measure : measures) sentences.push_back(sentence(summary, measure));
  for (const MethodSummary& method : summary.methods) {
    for (const FlagEntry& flag : flag_registry()) {
      if (std::find(method.flags.begin(), method.flags.end(), flag.name) == method.flags.end()) continue;
      sentences.push_back(fmt::format("{}: {} ({}).", method.method, flag.name, flag.meaning));
    }
  }
  return sentences;
}

}  // namespace gradslc
