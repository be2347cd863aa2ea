// Truevision TGA, after "Truevision TGA File Format Specification", version 2.0 (1991).

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <optional>

#include "scene/loaders/images/formats.h"

namespace gradslc {
namespace {

enum class Kind : std::uint8_t { mapped, colour, grey };

constexpr int k_right_to_left = 0x10, k_top_to_bottom = 0x20;  // bits of the descriptor

struct Header {
  std::uint8_t id_length;
  Kind kind;
  bool run_lengths;
  std::uint16_t map_first, map_length;
  std::uint8_t map_depth;  // bits
  std::uint16_t width, height;
  std::uint8_t depth, descriptor;
};

/// nullopt where the header is of no kind that we read.
std::optional<Header> read_header(ByteReader& reader) {
  Header header{};
  header.id_length = reader.u8();
  const std::uint8_t has_map = reader.u8(), type = reader.u8();
  if (has_map > 1 || (type & ~8) < 1 || (type & ~8) > 3) return std::nullopt;
  header.kind = static_cast<Kind>((type & 7) - 1);
  header.run_lengths = (type & 8) != 0;
  header.map_first = reader.u16();
  header.map_length = reader.u16();
  header.map_depth = reader.u8();
  reader.take(4);  // position on a screen
  header.width = reader.u16();
  header.height = reader.u16();
  header.depth = reader.u8();
  header.descriptor = reader.u8();
  const auto is_colour_depth = [](int bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; };
  const bool fits = header.kind == Kind::colour ? is_colour_depth(header.depth) : header.depth == 8;
  const bool map_fits = has_map == 1 ? is_colour_depth(header.map_depth) : header.kind != Kind::mapped;
  return fits && map_fits ? std::optional(header) : std::nullopt;
}

int channel_count(int depth) { return depth == 8 ? 1 : depth == 32 ? 4 : 3; }

/// Stored blue first, or as 5 bits each.
std::array<std::uint8_t, 4> read_pixel(ByteReader& reader, int depth) {
  if (depth == 8) return {reader.u8()};
  if (depth <= 16) {
    const unsigned int bits = reader.u16();
    const auto channel = [&](int shift) { return static_cast<std::uint8_t>(((bits >> shift) & 31) * 255 / 31); };
    return {channel(10), channel(5), channel(0), 255};
  }
  const std::uint8_t blue = reader.u8(), green = reader.u8(), red = reader.u8();
  return {red, green, blue, depth == 32 ? reader.u8() : std::uint8_t{255}};
}

class TgaReader {
 public:
  explicit TgaReader(const ImageBytes& image) : image_(image), reader_(image) {}

  Texels read() {
    const std::optional<Header> header = read_header(reader_);
    if (!header) image_.fail("is a TGA file of a kind that is not supported");
    header_ = *header;
    reader_.take(header_.id_length);
    const int colours = header_.kind == Kind::mapped ? header_.map_depth : header_.depth;
    Texels texels{{header_.width, header_.height}, channel_count(colours), {}};
    const auto channels = static_cast<std::size_t>(texels.channels);
    image_.check_size(header_.width, header_.height, channels);
    for (std::size_t i = 0; header_.map_depth > 0 && i < header_.map_length; ++i)
      map_.push_back(read_pixel(reader_, header_.map_depth));

    std::vector<std::uint8_t> values(texels.resolution.pixels() * channels);
    for (std::size_t i = 0; i < texels.resolution.pixels(); ++i) {
      const std::array<std::uint8_t, 4> pixel = next();
      std::copy_n(pixel.begin(), channels, values.begin() + static_cast<std::ptrdiff_t>(target(texels, i) * channels));
    }
    texels.values = std::move(values);
    return texels;
  }

 private:
  /// Where the i-th pixel of the file belongs.
  std::size_t target(const Texels& texels, std::size_t i) const {
    Pixel p = texels.resolution.pixel(i);
    if (header_.descriptor & k_right_to_left) p.x = texels.resolution.width - 1 - p.x;
    if (!(header_.descriptor & k_top_to_bottom)) p.y = texels.resolution.height - 1 - p.y;
    return texels.resolution.index(p);
  }

  std::array<std::uint8_t, 4> next() {
    if (!header_.run_lengths) return colour();
    if (left_ == 0) {
      const std::uint8_t packet = reader_.u8();
      left_ = (packet & 127) + 1;
      repeats_ = packet >= 128;
      if (repeats_) repeated_ = colour();
    }
    --left_;
    return repeats_ ? repeated_ : colour();
  }

  std::array<std::uint8_t, 4> colour() {
    const auto pixel = read_pixel(reader_, header_.depth);
    if (header_.kind != Kind::mapped) return pixel;
    const std::size_t index = pixel[0];
    if (index < header_.map_first || index - header_.map_first >= map_.size())
      image_.fail(fmt::format("is damaged: colour {} is not in its colour map", index));
    return map_[index - header_.map_first];
  }

  const ImageBytes& image_;
  ByteReader reader_;
  Header header_{};
  std::vector<std::array<std::uint8_t, 4>> map_;
  int left_ = 0;  // pixels of the packet
  bool repeats_ = false;
  std::array<std::uint8_t, 4> repeated_{};
};

}  // namespace

bool looks_like_tga(std::string_view bytes) {
  constexpr std::size_t k_header = 18;
  if (bytes.size() < k_header) return false;
  const std::string nameless;
  const ImageBytes image{bytes, nameless};
  ByteReader reader(image);
  return read_header(reader).has_value();
}

Texels decode_tga(const ImageBytes& image) { return TgaReader(image).read(); }

}  // namespace gradslc
