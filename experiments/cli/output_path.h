#pragma once

#include <filesystem>

namespace gradslc {

/// Throws Error (input) where `folder` could not be made or written in: asked before hours of work, not after them.
void require_writable_folder(const std::filesystem::path& folder);
/// The same for a file that is to be written.
void require_writable_file(const std::filesystem::path& file);

}  // namespace gradslc
