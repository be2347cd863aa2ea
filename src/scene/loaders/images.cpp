#include "scene/loaders/images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/error.h"
#include "core/exr.h"
#include "core/file.h"
#include "scene/loaders/images/formats.h"

namespace gradslc {
namespace {

constexpr std::uint64_t k_max_edge = 65536;
constexpr std::uint64_t k_max_expansion = 2000;
constexpr std::uint64_t k_always_allowed = 1 << 20;  // bytes

Texels to_texels(const RgbImage& image) {
  std::vector<float> values;
  values.reserve(3 * image.size());
  for (const Rgb& pixel : image) values.insert(values.end(), {pixel.r, pixel.g, pixel.b});
  return {image.resolution(), 3, std::move(values)};
}

Texels decode_by_signature(const ImageBytes& image, const std::string& bytes) {
  const std::string_view start(bytes);
  if (start.starts_with("\x89PNG\r\n\x1a\n")) return decode_png(image);
  if (start.starts_with("\xff\xd8\xff")) return decode_jpeg(image);
  if (start.starts_with("\x76\x2f\x31\x01")) return to_texels(decode_exr(bytes, image.file).image);
  if (start.starts_with("#?RADIANCE") || start.starts_with("#?RGBE")) return decode_hdr(image);
  if (start.starts_with("BM")) return decode_bmp(image);
  if (looks_like_tga(start)) return decode_tga(image);
  image.fail("is no image of a known format; known: png, jpg, tga, bmp, hdr, exr");
}

}  // namespace

void ImageBytes::fail(const std::string& message) const { throw_input_error(file, message); }

void ImageBytes::check_size(std::uint64_t width, std::uint64_t height, std::uint64_t bytes_per_pixel) const {
  if (width == 0 || height == 0) fail("is damaged: the image has no pixels");
  if (width > k_max_edge || height > k_max_edge)
    fail(fmt::format("the image has {} x {} pixels; at most {} x {} are supported", width, height, k_max_edge,
                     k_max_edge));
  if (width * height * bytes_per_pixel > std::max(k_always_allowed, k_max_expansion * bytes.size()))
    fail(fmt::format("is damaged: its header asks for {} x {} pixels, more than a file of {} bytes holds", width,
                     height, bytes.size()));
}

std::string_view ByteReader::take(std::size_t count) {
  if (count > remaining()) image_.fail(fmt::format("is truncated: ends after {} bytes", image_.bytes.size()));
  position_ += count;
  return image_.bytes.substr(position_ - count, count);
}

std::string_view ByteReader::line() {
  const std::size_t end = image_.bytes.find('\n', position_);
  if (end == std::string_view::npos) take(remaining() + 1);
  const std::string_view line = take(end - position_);
  take(1);
  return line;
}

void ByteReader::seek(std::size_t position) {
  position_ = 0;
  take(position);
}

std::uint32_t ByteReader::little_endian(std::size_t bytes) {
  std::uint32_t value = 0;
  const std::string_view text = take(bytes);
  for (std::size_t i = 0; i < bytes; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])) << (8 * i);
  return value;
}

Texels decode_image(const std::string& bytes, const std::filesystem::path& file) {
  const std::string name = file.string();
  const ImageBytes image{bytes, name};
  Texels texels = decode_by_signature(image, bytes);
  if (const auto* floats = std::get_if<std::vector<float>>(&texels.values))
    if (!std::all_of(floats->begin(), floats->end(), [](float value) { return std::isfinite(value); }))
      image.fail("has pixels that are no finite numbers");
  return texels;
}

Texels read_image(const std::filesystem::path& file) { return decode_image(read_file(file), file); }

}  // namespace gradslc
