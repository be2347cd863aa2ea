#include "experiments/cli/output_path.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/error.h"

namespace gradslc {

void require_writable_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::path existing = std::filesystem::absolute(folder);
  while (existing.has_relative_path() && !std::filesystem::exists(existing, ignored)) existing = existing.parent_path();
  if (!std::filesystem::is_directory(existing, ignored))
    throw_input_error(existing.string(), "is not a folder, so that nothing can be written in it");
  if (access(existing.c_str(), W_OK | X_OK) != 0)
    throw_input_error(existing.string(), std::string("folder cannot be written in: ") + std::strerror(errno));
}

void require_writable_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!file.has_filename() || std::filesystem::is_directory(file, ignored))
    throw_input_error(file.string(), "is a folder, the name of a file is needed");
  require_writable_folder(std::filesystem::absolute(file).parent_path());
}

}  // namespace gradslc
