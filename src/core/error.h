#pragma once

#include <exception>
#include <span>
#include <string>
#include <string_view>

namespace gradslc {

/// Where bad input stands: a file, and within it a line and column (1-based, 0 = unknown) and a JSON pointer or
/// element.
struct SourcePosition {
  std::string file;
  int line = 0, column = 0;
  std::string pointer;  ///< JSON pointer ("/methods/1/cut_size") or XML element ("shape[3]/bsdf"); may be empty
  std::string excerpt;  ///< text of the line, shown under the message, its token at `column` underlined; may be empty
};

/// The one exception type of the project. Caught in the CLI, printed as one line (plus the excerpt), and turned into
/// the exit code.
class Error : public std::exception {
 public:
  enum class Kind {
    input,   ///< the user's input is wrong (missing file, bad value): exit code 2
    failure  ///< the work could not be done (disk full, out of memory): exit code 1
  };
  /// `message` says what is wrong and what would be right, in one line without a full stop.
  Error(Kind kind, SourcePosition where, std::string message);

  Kind kind() const { return kind_; }
  const SourcePosition& where() const { return where_; }
  const std::string& message() const { return message_; }
  /// "file:line:column: error: pointer: message", then the excerpt and caret where known.
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  Kind kind_;
  SourcePosition where_;
  std::string message_, text_;
};

/// Bad input: exit code 2.
[[noreturn]] void throw_input_error(SourcePosition where, std::string message);
[[noreturn]] void throw_input_error(std::string_view file, std::string message);
/// Work that could not be done: exit code 1.
[[noreturn]] void throw_failure(std::string_view file, std::string message);

/// The candidate nearest to `name` in edit distance, or empty if none is near enough to be a plausible slip.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);
/// `; did you mean "x"?` or, where nothing is near, `; known: a, b, c`: the end of a message about an unknown name.
std::string suggestion(std::string_view name, std::span<const std::string> candidates);

}  // namespace gradslc
