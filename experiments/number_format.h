#pragma once

#include <string>

#include "experiments/statistics.h"

namespace gradslc {

/// How numbers stand in a table: Markdown and HTML text, or LaTeX math.
enum class Markup : std::uint8_t { text, latex };

/// A mean and its 95 % interval with as many digits as the interval deserves: "0.0123 ± 0.0041", "(1.23 ± 0.41)e-05".
/// Without an interval four significant digits: "0.01234"; a whole number that all repeats agree on stays one: "64".
std::string format_estimate(const Estimate& estimate, Markup markup);
/// The same in percent, with its sign: "-0.12 ± 0.05 %".
std::string format_percent(const Estimate& estimate, Markup markup);
/// Three significant digits: "1.42", "0.0751", "1.23e-05".
std::string format_number(double value, Markup markup);

}  // namespace gradslc
