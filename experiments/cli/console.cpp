#include "experiments/cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "experiments/cli/commands.h"

namespace gradslc {
namespace {

constexpr std::chrono::milliseconds k_terminal_interval{200}, k_log_interval{10000};

std::string duration_text(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

std::string progress_text(double fraction, double eta_seconds, const std::string& what) {
  std::string text = fmt::format("{:3.0f} %  {}", 100 * std::clamp(fraction, 0.0, 1.0), what);
  if (std::isfinite(eta_seconds) && eta_seconds >= 0) text += fmt::format(", {} left", duration_text(eta_seconds));
  return text;
}

}  // namespace

Console::Console(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), next_progress_(std::chrono::steady_clock::now()) {
  if (!terminal_) next_progress_ += k_log_interval;
}

Console::~Console() { clear_line(); }

void Console::clear_line() {
  if (line_shown_) std::fputs("\r\x1b[K", stderr);
  line_shown_ = false;
}

void Console::log(const std::string& line) {
  if (quiet_) return;
  clear_line();
  fmt::print(stderr, "{}\n", line);
}

void Console::progress(double fraction, double eta_seconds, const std::string& what) {
  const Time now = std::chrono::steady_clock::now();
  if (quiet_ || now < next_progress_) return;
  next_progress_ = now + (terminal_ ? k_terminal_interval : k_log_interval);
  if (!terminal_) return log(progress_text(fraction, eta_seconds, what));
  clear_line();
  fmt::print(stderr, "{}", progress_text(fraction, eta_seconds, what));
  std::fflush(stderr);
  line_shown_ = true;
}

int report_problems(const Problems& problems) {
  for (const Error& error : problems.all()) fmt::print(stderr, "{}\n", error.what());
  return problems.empty() ? k_done : k_bad_input;
}

}  // namespace gradslc
