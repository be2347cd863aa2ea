#pragma once

#include <functional>
#include <optional>
#include <string>

namespace gradslc {

/// The value of an environment variable; nullopt where it is not set.
using Environment = std::function<std::optional<std::string>(const std::string& name)>;
/// This process's.
Environment process_environment();

struct ExpandedText {
  std::string text;   ///< with every ${NAME} replaced
  std::string error;  ///< what is wrong; empty if nothing is
};
/// Replaces every ${NAME} by that environment variable.
ExpandedText expand_environment(const std::string& text, const Environment& environment);

}  // namespace gradslc
