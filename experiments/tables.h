#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/number_format.h"
#include "experiments/summary.h"

namespace gradslc {

/// A table of text, as it stands in Markdown, HTML or LaTeX; the cells are marked up for their target.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// One row per method: errors, time, passes, rays, inefficiency, factors against the first method, flags. Columns of
/// what was not measured are left out.
TextTable result_table(const SceneSummary& summary, Markup markup);

std::string markdown_table(const TextTable& table);
/// A table environment with booktabs rules for each scene.
std::string latex_tables(std::span<const SceneSummary> summaries);

/// Text with LaTeX's special characters escaped.
std::string latex_text(const std::string& text);

}  // namespace gradslc
