// Radiance RGBE pictures, after Ward, "Real Pixels" (Graphics Gems II, 1991) and the Radiance file formats manual.

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>

#include "scene/loaders/images/formats.h"

namespace gradslc {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// "-Y height +X width", the order that is used everywhere.
std::optional<std::array<std::uint32_t, 2>> parse_size(std::string_view line) {
  std::array<std::uint32_t, 2> size{};
  const auto read = [&](std::string_view axis, std::uint32_t& value) {
    if (!line.starts_with(axis)) return false;
    line.remove_prefix(axis.size());
    const auto [end, failure] = std::from_chars(line.data(), line.data() + line.size(), value);
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    return failure == std::errc();
  };
  if (!read("-Y ", size[1]) || !read(" +X ", size[0]) || !line.empty()) return std::nullopt;
  return size;
}

/// Each of the four bytes in turn for the whole line, in runs: counts above 128 repeat one value.
void read_separate_runs(const ImageBytes& image, ByteReader& reader, std::vector<Rgbe>& line) {
  for (std::size_t channel = 0; channel < 4; ++channel)
    for (std::size_t x = 0; x < line.size();) {
      const std::size_t code = reader.u8();
      const std::size_t count = code > 128 ? code - 128 : code;
      if (count == 0 || count > line.size() - x) image.fail("is damaged: a run is longer than its line");
      const bool repeats = code > 128;
      std::uint8_t value = repeats ? reader.u8() : std::uint8_t{0};
      for (const std::size_t end = x + count; x < end; ++x) {
        if (!repeats) value = reader.u8();
        line[x][channel] = value;
      }
    }
}

/// Whole pixels; 1, 1, 1, n repeats the last one n times, and n 256^k times where k such follow each other.
void read_pixels(const ImageBytes& image, ByteReader& reader, Rgbe first, std::vector<Rgbe>& line) {
  std::size_t x = 0;
  int shift = 0;
  for (Rgbe pixel = first;; pixel = {reader.u8(), reader.u8(), reader.u8(), reader.u8()}) {
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      if (x == 0 || shift > 16) image.fail("is damaged: a run without a pixel to repeat");
      const std::size_t count = std::size_t{pixel[3]} << shift;
      if (count > line.size() - x) image.fail("is damaged: a run is longer than its line");
      for (const std::size_t end = x + count; x < end; ++x) line[x] = line[x - 1];
      shift += 8;
    } else {
      line[x++] = pixel;
      shift = 0;
    }
    if (x == line.size()) return;
  }
}

void read_line(const ImageBytes& image, ByteReader& reader, std::vector<Rgbe>& line) {
  const Rgbe start{reader.u8(), reader.u8(), reader.u8(), reader.u8()};
  const bool in_runs = start[0] == 2 && start[1] == 2 && start[2] < 128 &&
                       (std::size_t{start[2]} << 8 | start[3]) == line.size() && line.size() >= 8;
  if (in_runs)
    read_separate_runs(image, reader, line);
  else
    read_pixels(image, reader, start, line);
}

}  // namespace

Texels decode_hdr(const ImageBytes& image) {
  ByteReader reader(image);
  reader.line();  // the signature
  for (std::string_view line = reader.line(); !line.empty(); line = reader.line())
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
      image.fail("is an HDR file of another format than 32-bit_rle_rgbe, which alone is supported");
  const auto size = parse_size(reader.line());
  if (!size) image.fail("is an HDR file whose size is not given as \"-Y height +X width\"");
  image.check_size((*size)[0], (*size)[1], 3 * sizeof(float));

  Texels texels{{static_cast<int>((*size)[0]), static_cast<int>((*size)[1])}, 3, {}};
  std::vector<float> values;
  values.reserve(3 * texels.resolution.pixels());
  std::vector<Rgbe> line(static_cast<std::size_t>(texels.resolution.width));
  for (int y = 0; y < texels.resolution.height; ++y) {
    read_line(image, reader, line);
    for (const Rgbe& pixel : line) {
      const float unit = pixel[3] == 0 ? 0 : std::ldexp(1.0f, pixel[3] - (128 + 8));
      for (std::size_t c = 0; c < 3; ++c) values.push_back(unit * static_cast<float>(pixel[c]));
    }
  }
  texels.values = std::move(values);
  return texels;
}

}  // namespace gradslc
