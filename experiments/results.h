#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/metrics.h"

namespace gradslc {

/// One line of results.csv: a method at one curve point of one repeat.
struct ResultRow {
  std::string scene, method;
  int point = 0;            ///< of the sweep; 0 without one
  int repeat = 0;           ///< from 0
  int passes = 0;           ///< = samples per pixel
  double wall_seconds = 0;  ///< prepare + render + this point's reconstruct
  double cpu_seconds = 0;   ///< of the same
  double prepare_seconds = 0, render_seconds = 0, reconstruct_seconds = 0;  ///< wall
  std::uint64_t rays = 0;
  std::vector<Metric> metrics;          ///< all of metric_registry(), or none without a reference
  double target = 0;                    ///< passes or seconds that the curve point was planned for
  bool final = false;                   ///< the whole budget
  std::optional<double> budget_miss;    ///< wall_seconds / budget - 1; final points of budgets in seconds
  std::optional<double> primal_relmse;  ///< of the image without its reconstruction, where it has one
  /// Of the light that VPLs can represent alone; without reconstruction, where the experiment has parts.
  std::optional<double> vpl_light_relmse, vpl_light_relmse_trimmed;
  std::optional<double> reference_noise;  ///< relmse of the reference itself
  std::vector<std::string> flags;         ///< names of k_flags

  bool has_flag(std::string_view flag) const;
  /// nullopt where it was not measured.
  std::optional<double> metric(std::string_view name) const;
};

/// What a row may say of itself, with the meaning that reports print.
struct FlagEntry {
  const char* name;
  const char* meaning;
};
std::span<const FlagEntry> flag_registry();

/// Rows as CSV (RFC 4180, but lines end with a line feed), with a header; numbers so that reading gives the same bits.
std::string to_csv(std::span<const ResultRow> rows);
/// The rows of a CSV file with at least the header's columns in any order. Error (input) with the line where it is
/// broken.
std::vector<ResultRow> read_results(const std::filesystem::path& file);

}  // namespace gradslc
