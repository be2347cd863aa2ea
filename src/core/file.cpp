#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
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

constexpr std::size_t k_read_step = 65536;  // bytes, where a file's size is not known before

/// An open file's number, closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

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
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.value() < 0) throw_input_error(path.string(), "cannot be opened: " + last_error());
  struct stat status {};
  const bool sized = fstat(file.value(), &status) == 0 && S_ISREG(status.st_mode);
  std::string content(sized ? static_cast<std::size_t>(status.st_size) + 1 : k_read_step, '\0');
  for (std::size_t size = 0;;) {
    const ssize_t count = read(file.value(), content.data() + size, content.size() - size);
    if (count < 0 && errno != EINTR) throw_input_error(path.string(), "cannot be read: " + last_error());
    if (count > 0) size += static_cast<std::size_t>(count);
    if (count == 0) {
      content.resize(size);
      return content;
    }
    if (size == content.size()) content.resize(size + std::max(size, k_read_step));
  }
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
