#include <fmt/format.h>
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>

#include "scene/loaders/images/formats.h"

namespace gradslc {
namespace {

/// libpng's reader over bytes in memory. libpng reports errors by a long jump: only guarded() may call it, and what
/// runs there holds no objects with destructors.
class PngReader {
 public:
  explicit PngReader(const ImageBytes& image) : image_(image), rest_(image.bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, [](png_structp, png_const_charp) {});
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  Texels read() {
    if (!info_) image_.fail("cannot be read: libpng is of another version, or there is no memory");
    guarded([this] { read_header(); });
    const std::uint64_t width = png_get_image_width(png_, info_), height = png_get_image_height(png_, info_);
    const std::size_t channels = png_get_channels(png_, info_), row_bytes = png_get_rowbytes(png_, info_);
    const bool wide = png_get_bit_depth(png_, info_) == 16;
    image_.check_size(width, height, channels * (wide ? 2 : 1));

    Texels texels{{static_cast<int>(width), static_cast<int>(height)}, static_cast<int>(channels), {}};
    const std::size_t count = texels.resolution.pixels() * channels;
    if (wide)
      texels.values = std::vector<std::uint16_t>(count);
    else
      texels.values = std::vector<std::uint8_t>(count);
    std::vector<png_bytep> rows(height);
    std::visit(
        [&](auto& values) {
          auto* const first = reinterpret_cast<png_bytep>(values.data());
          for (std::size_t y = 0; y < height; ++y) rows[y] = first + y * row_bytes;
        },
        texels.values);
    guarded([this, &rows] {
      png_read_image(png_, rows.data());
      png_read_end(png_, nullptr);
    });
    return texels;
  }

 private:
  template <class Step>
  void guarded(const Step& step) {
    if (setjmp(jump_) != 0) image_.fail(fmt::format("is no readable PNG file: {}", message_));
    step();
  }

  void read_header() {
    png_set_read_fn(png_, this, on_read);
    png_read_info(png_, info_);
    png_set_expand(png_);  // palettes, fewer than 8 bits, transparent colours
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
  }

  static void on_read(png_structp png, png_bytep data, std::size_t size) {
    auto* const reader = static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > reader->rest_.size()) png_error(png, "it is truncated");
    std::memcpy(data, reader->rest_.data(), size);
    reader->rest_.remove_prefix(size);
  }
  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    auto* const reader = static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(reader->message_, message, sizeof reader->message_ - 1);
    std::longjmp(reader->jump_, 1);
  }

  const ImageBytes& image_;
  std::string_view rest_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::jmp_buf jump_{};
  char message_[128] = {};
};

}  // namespace

Texels decode_png(const ImageBytes& image) { return PngReader(image).read(); }

}  // namespace gradslc
