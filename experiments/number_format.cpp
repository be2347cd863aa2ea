#include "experiments/number_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gradslc {
namespace {

constexpr int k_smallest_plain_exponent = -3, k_largest_plain_exponent = 5;
constexpr int k_most_decimals = 6;

int decimal_exponent(double value) {
  return value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
}

/// Decimals that show `digits` significant digits of a number with this exponent.
int decimals_for(int exponent, int digits) { return std::clamp(digits - 1 - exponent, 0, k_most_decimals); }

std::string times_power_of_ten(const std::string& mantissa, int exponent, Markup markup) {
  if (markup == Markup::latex) return fmt::format("{} \\times 10^{{{}}}", mantissa, exponent);
  return fmt::format("{}e{:+03}", mantissa, exponent);
}

/// `sign` is "" or "+": whether positive means show theirs.
std::string format_interval(Estimate e, int digits_alone, const char* sign, Markup markup) {
  const bool has_interval = std::isfinite(e.half_width) && e.half_width > 0;
  const int exponent = decimal_exponent(e.mean);
  const bool plain = exponent >= k_smallest_plain_exponent && exponent <= k_largest_plain_exponent;
  if (!plain) {
    const double scale = std::pow(10.0, -exponent);
    e.mean *= scale;
    e.half_width *= scale;
  }
  const int decimals = has_interval ? decimals_for(decimal_exponent(e.half_width), 2)
                                    : decimals_for(decimal_exponent(e.mean), digits_alone);
  std::string text =
      sign[0] == '+' ? fmt::format("{:+.{}f}", e.mean, decimals) : fmt::format("{:.{}f}", e.mean, decimals);
  if (has_interval)
    text += fmt::format("{}{:.{}f}", markup == Markup::latex ? " \\pm " : " ± ", e.half_width, decimals);
  if (plain) return text;
  return times_power_of_ten(has_interval ? "(" + text + ")" : text, exponent, markup);
}

std::string in_math(const std::string& text, Markup markup) {
  return markup == Markup::latex ? "$" + text + "$" : text;
}

}  // namespace

std::string format_estimate(const Estimate& estimate, Markup markup) {
  const bool is_count = estimate.mean == std::round(estimate.mean) && estimate.half_width == 0;
  if (is_count && decimal_exponent(estimate.mean) <= k_largest_plain_exponent) {
    return in_math(fmt::format("{:.0f}", estimate.mean), markup);
  }
  return in_math(format_interval(estimate, 4, "", markup), markup);
}

std::string format_percent(const Estimate& estimate, Markup markup) {
  const Estimate percent{100 * estimate.mean, 100 * estimate.half_width, estimate.count};
  return in_math(format_interval(percent, 3, "+", markup), markup) + (markup == Markup::latex ? "\\,\\%" : " %");
}

std::string format_number(double value, Markup markup) {
  return in_math(format_interval(Estimate{value, INFINITY, 1}, 3, "", markup), markup);
}

}  // namespace gradslc
