#pragma once

#include <zlib.h>

#include <array>
#include <cstddef>
#include <istream>
#include <string>

namespace gradslc {

/// Reads a zlib stream that is part of a file.
class InflateStream {
 public:
  /// From the place where `source` stands, at most `size` bytes. `file` is its name in messages.
  InflateStream(std::istream& source, std::size_t size, std::string file);
  ~InflateStream();
  InflateStream(const InflateStream&) = delete;
  InflateStream& operator=(const InflateStream&) = delete;

  /// Fills `target` with exactly `size` bytes; throws Error (input) where the data end before or are damaged.
  void read(void* target, std::size_t size);
  /// Most bytes that may still come out: deflate never expands by more than 1032 (RFC 1951: 258 bytes for two bits).
  std::size_t max_remaining() const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  bool refill();

  std::istream& source_;
  std::size_t unread_;
  std::string file_;
  std::size_t position_;  // byte of the file behind the buffer
  z_stream state_{};
  std::array<unsigned char, 65536> buffer_{};
};

}  // namespace gradslc
