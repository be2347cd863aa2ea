#pragma once

#include <filesystem>

namespace gradslc {

/// Writes report.md, report.html (self-contained), table.tex, plots/ and images/ into a results folder, from its
/// results.csv, manifests and images alone. What is missing of the images is left out; Error (input) where results.csv
/// is missing or broken.
void write_report(const std::filesystem::path& results_folder);

}  // namespace gradslc
