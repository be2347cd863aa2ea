#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace gradslc {

/// Whole content of a file; Error (input) where it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// Lets `write` make a file under a temporary name beside `path`, syncs it and renames it to `path`, so that `path` is
/// either the old file or the whole new one. On an exception, or where the disk is full or the folder cannot be written
/// (Error, input), the temporary file is removed. Creates missing parent folders.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path& temporary)>& write);
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace gradslc
