#pragma once
// Image files put together byte by byte after their published layouts, as oracles that share no code with the readers.

#include <array>
#include <cstdint>
#include <string>

namespace gradslc::test {

inline std::string big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}
inline std::string little_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
  return text;
}

inline std::string png_chunk(const std::string& kind, const std::string& content) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : kind + content) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
  }
  return big_endian(static_cast<std::uint32_t>(content.size())) + kind + content + big_endian(~crc);
}

/// `rows`: the pixels, each row after its filter type 0. Stored without compression; at most 65535 bytes.
inline std::string png(std::uint32_t width, std::uint32_t height, int depth, int colour_type, const std::string& rows,
                       const std::string& chunks = {}) {
  std::uint32_t a = 1, b = 0;  // Adler-32
  for (const char c : rows) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto size = static_cast<std::uint32_t>(rows.size());
  const std::string deflated =
      "\x78\x01\x01" + little_endian(size, 2) + little_endian(~size, 2) + rows + big_endian(b << 16 | a);
  const std::string header = big_endian(width) + big_endian(height) + static_cast<char>(depth) +
                             static_cast<char>(colour_type) + std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + chunks + png_chunk("IDAT", deflated) + png_chunk("IEND", "");
}

/// Top to bottom where `descriptor` has bit 5; `body` is what follows the header.
inline std::string tga(int type, int width, int height, int depth, int descriptor, const std::string& body,
                       int map_length = 0, int map_depth = 0) {
  return std::string{'\0', static_cast<char>(map_length > 0), static_cast<char>(type)} + little_endian(0, 2) +
         little_endian(static_cast<std::uint32_t>(map_length), 2) + static_cast<char>(map_depth) +
         std::string(4, '\0') + little_endian(static_cast<std::uint32_t>(width), 2) +
         little_endian(static_cast<std::uint32_t>(height), 2) + static_cast<char>(depth) +
         static_cast<char>(descriptor) + body;
}

/// `body`: palette and rows; the pixels begin `offset` bytes into it.
inline std::string bmp(int width, int height, int depth, const std::string& body, int offset = 0) {
  const auto u32 = [](int value) { return little_endian(static_cast<std::uint32_t>(value), 4); };
  return "BM" + u32(54 + static_cast<int>(body.size())) + u32(0) + u32(54 + offset) + u32(40) + u32(width) +
         u32(height) + little_endian(1, 2) + little_endian(static_cast<std::uint32_t>(depth), 2) +
         std::string(24, '\0') + body;
}

inline std::string hdr(const std::string& size, const std::string& body) {
  return "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n" + body;
}

}  // namespace gradslc::test
