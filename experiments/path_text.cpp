#include "experiments/path_text.h"

#include <cstdlib>

namespace gradslc {

Environment process_environment() {
  return [](const std::string& name) -> std::optional<std::string> {
    const char* value = std::getenv(name.c_str());
    return value ? std::optional<std::string>(value) : std::nullopt;
  };
}

ExpandedText expand_environment(const std::string& text, const Environment& environment) {
  ExpandedText expanded;
  std::size_t at = 0;
  while (true) {
    const std::size_t begin = text.find("${", at);
    expanded.text += text.substr(at, begin - at);
    if (begin == text.npos) return expanded;
    const std::size_t end = text.find('}', begin);
    if (end == text.npos) return {{}, "\"${\" is not closed by \"}\""};
    const std::string name = text.substr(begin + 2, end - begin - 2);
    const std::optional<std::string> value = environment(name);
    if (!value) return {{}, "environment variable \"" + name + "\" is not set"};
    expanded.text += *value;
    at = end + 1;
  }
}

}  // namespace gradslc
