#include "experiments/cli/output_path.h"

#include <fcntl.h>
#include <fmt/format.h>
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
  // Permissions alone do not tell: root passes them, and file systems may be read-only or hold no files of ours.
  const std::filesystem::path probe = existing / fmt::format(".gradslc-{}.probe", getpid());
  const int descriptor = open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0)
    throw_input_error(existing.string(), std::string("folder cannot be written in: ") + std::strerror(errno));
  close(descriptor);
  unlink(probe.c_str());
}

void require_writable_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!file.has_filename() || std::filesystem::is_directory(file, ignored))
    throw_input_error(file.string(), "is a folder, the name of a file is needed");
  require_writable_folder(std::filesystem::absolute(file).parent_path());
}

}  // namespace gradslc
