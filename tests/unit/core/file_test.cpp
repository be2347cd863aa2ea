#include "core/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "core/error.h"

namespace gradslc {
namespace {

namespace fs = std::filesystem;

class FileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "gradslc-file-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::size_t files() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }

  fs::path folder_;
};

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(FileTest, WritesAndReadsBackAllBytes) {
  const std::string content("line\n\0binary\xff\r\n", 15);
  write_file_atomically(folder_ / "a" / "b" / "file", content);
  EXPECT_EQ(read_file(folder_ / "a" / "b" / "file"), content);
  write_file_atomically(folder_ / "a" / "b" / "file", "");
  EXPECT_EQ(read_file(folder_ / "a" / "b" / "file"), "");
}

TEST_F(FileTest, KeepsTheOldFileAndNothingElseWhenWritingThrows) {
  write_file_atomically(folder_ / "file", "old");
  const auto half_written = [](const fs::path& temporary) {
    std::ofstream(temporary) << "half";
    throw std::runtime_error("interrupted");
  };
  EXPECT_THROW(write_file_atomically(folder_ / "file", half_written), std::runtime_error);
  EXPECT_EQ(read_file(folder_ / "file"), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileTest, ReplacesTheOldFileOnlyWhenTheNewOneIsWhole) {
  write_file_atomically(folder_ / "file", "old");
  write_file_atomically(folder_ / "file", [&](const fs::path& temporary) {
    std::ofstream(temporary) << "new";
    EXPECT_EQ(read_file(folder_ / "file"), "old");
    EXPECT_EQ(temporary.parent_path(), folder_);
  });
  EXPECT_EQ(read_file(folder_ / "file"), "new");
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileTest, ForgottenTemporaryFileIsAnError) {
  const std::string message = message_of([&] { write_file_atomically(folder_ / "file", [](const fs::path&) {}); });
  EXPECT_TRUE(contains(message, "No such file")) << message;
  EXPECT_EQ(files(), 0u);
}

TEST_F(FileTest, FolderThatCannotBeMadeIsAnError) {
  write_file_atomically(folder_ / "plain", "");
  const std::string below_a_file = message_of([&] { write_file_atomically(folder_ / "plain" / "sub" / "file", "x"); });
  EXPECT_TRUE(contains(below_a_file, "folder cannot be made")) << below_a_file;
  const std::string over_a_folder = message_of([&] {
    fs::create_directories(folder_ / "taken" / "inside");
    write_file_atomically(folder_ / "taken", "x");
  });
  EXPECT_TRUE(contains(over_a_folder, "cannot be written")) << over_a_folder;
  EXPECT_EQ(files(), 2u);
}

TEST_F(FileTest, FolderWithoutWritePermissionIsAnError) {
  // Root may write anywhere but below /proc, where nobody can make a file.
  const fs::path locked = folder_ / "locked";
  fs::create_directory(locked);
  fs::permissions(locked, fs::perms::owner_read | fs::perms::owner_exec);
  const fs::path target = geteuid() == 0 ? fs::path("/proc/self/gradslc-test-file") : locked / "file";
  const std::string message = message_of([&] { write_file_atomically(target, "x"); });
  EXPECT_TRUE(contains(message, "cannot be written")) << message;
  EXPECT_TRUE(contains(message, target.string())) << message;
  fs::permissions(locked, fs::perms::owner_all);
}

/// Makes files longer than `bytes` fail to be written, as on a full disk, until it is destroyed.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(FileTest, FullDiskIsAnErrorAndLeavesTheOldFile) {
  write_file_atomically(folder_ / "file", "old");
  std::string message;
  {
    const FileSizeLimit limit(4096);
    message = message_of([&] { write_file_atomically(folder_ / "file", std::string(100'000, 'x')); });
  }
  EXPECT_TRUE(contains(message, "cannot be written: File too large")) << message;
  EXPECT_EQ(read_file(folder_ / "file"), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileTest, ReadingWhatIsNoReadableFileIsAnInputError) {
  const std::string missing = message_of([&] { read_file(folder_ / "missing"); });
  EXPECT_TRUE(contains(missing, "missing: error: cannot be opened: No such file")) << missing;
  const std::string folder = message_of([&] { read_file(folder_); });
  EXPECT_TRUE(contains(folder, "is a folder, a file is needed")) << folder;
}

}  // namespace
}  // namespace gradslc
