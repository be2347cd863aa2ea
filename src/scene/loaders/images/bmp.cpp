// Windows bitmaps with a BITMAPINFOHEADER or a later version of it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "scene/loaders/images/formats.h"

namespace gradslc {
namespace {

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

struct Header {
  std::uint32_t pixels;  // where they begin
  std::uint32_t info_size;
  std::int64_t width, height;
  bool top_down;
  int depth;  // bits
  std::uint32_t palette_size;
};

constexpr std::uint32_t k_file_header = 14, k_info_header = 40;

Header read_header(const ImageBytes& image, ByteReader& reader) {
  Header header{};
  reader.take(10);
  header.pixels = reader.u32();
  header.info_size = reader.u32();
  if (header.info_size < k_info_header) image.fail("is a BMP file of a version that is not supported");
  header.width = static_cast<std::int32_t>(reader.u32());
  header.height = static_cast<std::int32_t>(reader.u32());
  header.top_down = header.height < 0;
  header.height = std::abs(header.height);
  if (header.width < 0) image.fail("is damaged: its width is negative");
  reader.take(2);  // planes
  header.depth = reader.u16();
  const std::uint32_t compression = reader.u32();
  constexpr int k_depths[] = {1, 4, 8, 24, 32};
  if (compression != 0 || std::find(std::begin(k_depths), std::end(k_depths), header.depth) == std::end(k_depths))
    image.fail("is a BMP file of a kind that is not supported: only 1, 4, 8, 24 and 32 bits without compression are");
  reader.take(12);  // size of the pixels, resolution
  header.palette_size = reader.u32();
  return header;
}

std::vector<Colour> read_palette(const ImageBytes& image, ByteReader& reader, const Header& header) {
  if (header.depth > 8) return {};
  const std::uint32_t most = 1u << header.depth;
  const std::uint32_t size = header.palette_size == 0 ? most : header.palette_size;
  if (size > most) image.fail(fmt::format("is damaged: {} colours for {} bits", size, header.depth));
  reader.seek(std::size_t{k_file_header} + header.info_size);
  std::vector<Colour> palette;
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint8_t blue = reader.u8(), green = reader.u8(), red = reader.u8();
    reader.take(1);
    palette.push_back({red, green, blue});
  }
  return palette;
}

Colour read_pixel(const ImageBytes& image, std::string_view row, std::size_t x, int depth,
                  const std::vector<Colour>& palette) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(row[i]); };
  const auto bits = static_cast<std::size_t>(depth);
  if (depth >= 24) {
    const std::size_t first = x * bits / 8;
    return {byte(first + 2), byte(first + 1), byte(first)};
  }
  const std::size_t shift = 8 - bits - x * bits % 8;
  const std::size_t index = static_cast<std::size_t>(byte(x * bits / 8) >> shift) & ((1u << bits) - 1);
  if (index >= palette.size()) image.fail(fmt::format("is damaged: colour {} is not in its palette", index));
  return palette[index];
}

}  // namespace

Texels decode_bmp(const ImageBytes& image) {
  ByteReader reader(image);
  const Header header = read_header(image, reader);
  image.check_size(static_cast<std::uint64_t>(header.width), static_cast<std::uint64_t>(header.height), 3);
  const std::vector<Colour> palette = read_palette(image, reader, header);
  reader.seek(header.pixels);

  Texels texels{{static_cast<int>(header.width), static_cast<int>(header.height)}, 3, {}};
  std::vector<std::uint8_t> values(3 * texels.resolution.pixels());
  const auto width = static_cast<std::size_t>(header.width);
  const std::size_t row_bytes = (width * static_cast<std::size_t>(header.depth) + 31) / 32 * 4;
  for (int i = 0; i < texels.resolution.height; ++i) {
    const std::string_view row = reader.take(row_bytes);
    const int y = header.top_down ? i : texels.resolution.height - 1 - i;
    for (std::size_t x = 0; x < width; ++x) {
      const Colour colour = read_pixel(image, row, x, header.depth, palette);
      const std::size_t target = 3 * texels.resolution.index({static_cast<int>(x), y});
      std::copy(colour.begin(), colour.end(), values.begin() + static_cast<std::ptrdiff_t>(target));
    }
  }
  texels.values = std::move(values);
  return texels;
}

}  // namespace gradslc
