#pragma once
// The decoders behind read_image(), one for each format. Each throws Error (input).

#include <cstdint>
#include <string>
#include <string_view>

#include "materials/texels.h"

namespace gradslc {

/// An image file in memory.
struct ImageBytes {
  std::string_view bytes;
  const std::string& file;  ///< its name in messages

  [[noreturn]] void fail(const std::string& message) const;
  /// Refuses sizes that are zero, larger than 65536, or need more memory than a file of that size can mean: two
  /// thousand times its bytes (deflate reaches 1032, JPEG about 1000).
  void check_size(std::uint64_t width, std::uint64_t height, std::uint64_t bytes_per_pixel) const;
};

/// Reads numbers from the beginning to the end; an Error where there are no more.
class ByteReader {
 public:
  explicit ByteReader(const ImageBytes& image) : image_(image) {}

  // Little-endian.
  std::uint8_t u8() { return static_cast<std::uint8_t>(little_endian(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(little_endian(2)); }
  std::uint32_t u32() { return little_endian(4); }
  std::string_view take(std::size_t count);
  /// Up to the next line feed, which is dropped.
  std::string_view line();
  void seek(std::size_t position);
  std::size_t remaining() const { return image_.bytes.size() - position_; }

 private:
  std::uint32_t little_endian(std::size_t bytes);

  const ImageBytes& image_;
  std::size_t position_ = 0;
};

Texels decode_png(const ImageBytes& image);
Texels decode_jpeg(const ImageBytes& image);
Texels decode_tga(const ImageBytes& image);
Texels decode_bmp(const ImageBytes& image);
Texels decode_hdr(const ImageBytes& image);

/// TGA files do not begin with a signature: whether the header is one that decode_tga() reads.
bool looks_like_tga(std::string_view bytes);

}  // namespace gradslc
