#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/error.h"

namespace gradslc {
namespace {

std::string last_error() { return std::strerror(errno); }

void sync_to_disk(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw_input_error(path.string(), "cannot be synced: " + last_error());
  const bool synced = fsync(descriptor) == 0;
  const std::string reason = last_error();
  close(descriptor);
  if (!synced) throw_input_error(path.string(), "cannot be synced: " + reason);
}

/// A temporary file's name; the file is removed unless it has been renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target)
      : path_(target.string() + fmt::format(".{}.tmp", getpid())) {}
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw_input_error(path.string(), "is a folder, a file is needed");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw_input_error(path.string(), "cannot be opened: " + last_error());
  std::ostringstream content;
  content << stream.rdbuf();
  if (stream.bad()) throw_input_error(path.string(), "cannot be read: " + last_error());
  return std::move(content).str();
}

void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path&)>& write) {
  std::error_code failure;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), failure);
  if (failure) throw_input_error(path.parent_path().string(), "folder cannot be made: " + failure.message());
  const TemporaryFile temporary(path);
  write(temporary.path());
  sync_to_disk(temporary.path());
  std::filesystem::rename(temporary.path(), path, failure);
  if (failure) throw_input_error(path.string(), "cannot be written: " + failure.message());
}

void write_file_atomically(const std::filesystem::path& path, std::string_view content) {
  write_file_atomically(path, [&](const std::filesystem::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    if (!stream) throw_input_error(path.string(), "cannot be written: " + last_error());
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) throw_input_error(path.string(), "cannot be written: " + last_error());
  });
}

}  // namespace gradslc
