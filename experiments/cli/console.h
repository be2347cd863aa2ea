#pragma once

#include <chrono>
#include <string>

#include "experiments/problems.h"

namespace gradslc {

/// What a long command says on stderr: on a terminal a line that is overwritten, else a line now and then; or nothing.
class Console {
 public:
  explicit Console(bool quiet);
  /// Removes the progress line.
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  void log(const std::string& line);
  /// `fraction` of the work is done; the rest is likely to take `eta_seconds` (negative or not finite: not known).
  void progress(double fraction, double eta_seconds, const std::string& what);

 private:
  using Time = std::chrono::steady_clock::time_point;
  void clear_line();

  bool quiet_, terminal_;
  bool line_shown_ = false;
  Time next_progress_;
};

/// Prints all problems to stderr; the exit code.
int report_problems(const Problems& problems);

}  // namespace gradslc
