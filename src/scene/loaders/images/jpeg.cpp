#include <fmt/format.h>

#include <cstddef>
#include <cstdio>

#include <jpeglib.h>
// after jpeglib.h
#include <jerror.h>

#include <csetjmp>
#include <limits>

#include "scene/loaders/images/formats.h"

namespace gradslc {
namespace {

/// Progressive files may go over the whole image in as many scans as they like; encoders use about ten.
constexpr int k_max_scans = 500;

/// libjpeg's decompressor over bytes in memory. libjpeg reports errors by a long jump here: only guarded() may call it,
/// and what runs there holds no objects with destructors.
class JpegReader {
 public:
  explicit JpegReader(const ImageBytes& image) : image_(image) {
    info_.err = jpeg_std_error(&errors_);
    info_.client_data = this;
    errors_.error_exit = on_error;
    errors_.emit_message = on_message;
    progress_.progress_monitor = on_progress;
  }
  ~JpegReader() { jpeg_destroy_decompress(&info_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  Texels read() {
    if (image_.bytes.size() > std::numeric_limits<unsigned long>::max()) image_.fail("is too large");
    guarded([this] { read_header(); });
    const std::size_t channels = info_.num_components == 1 ? 1 : 3;
    image_.check_size(info_.image_width, info_.image_height, channels);

    Texels texels{
        {static_cast<int>(info_.image_width), static_cast<int>(info_.image_height)}, static_cast<int>(channels), {}};
    std::vector<std::uint8_t> values(texels.resolution.pixels() * channels);
    guarded([this, &values] { read_rows(values.data()); });
    texels.values = std::move(values);
    return texels;
  }

 private:
  template <class Step>
  void guarded(const Step& step) {
    if (setjmp(jump_) != 0) image_.fail(fmt::format("is no readable JPEG file: {}", message_));
    step();
  }

  void read_header() {
    jpeg_create_decompress(&info_);
    info_.progress = &progress_;
    jpeg_mem_src(&info_, reinterpret_cast<const unsigned char*>(image_.bytes.data()),
                 static_cast<unsigned long>(image_.bytes.size()));
    jpeg_read_header(&info_, TRUE);
    info_.out_color_space = info_.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  }

  void read_rows(std::uint8_t* next) {
    jpeg_start_decompress(&info_);
    const std::size_t row_bytes = std::size_t{info_.output_width} * static_cast<std::size_t>(info_.output_components);
    while (info_.output_scanline < info_.output_height) {
      JSAMPROW row = next;
      next += row_bytes * jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_finish_decompress(&info_);
  }

  [[noreturn]] static void on_error(j_common_ptr info) {
    auto* const reader = static_cast<JpegReader*>(info->client_data);
    info->err->format_message(info, reader->message_);
    std::longjmp(reader->jump_, 1);
  }
  /// What libjpeg fills in for missing or wrong data is an error here; harmless warnings are not.
  static void on_message(j_common_ptr info, int level) {
    const int code = info->err->msg_code;
    if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_ADOBE_XFORM && code != JWRN_JFIF_MAJOR)
      on_error(info);
  }
  static void on_progress(j_common_ptr info) {
    auto* const reader = static_cast<JpegReader*>(info->client_data);
    if (reader->info_.input_scan_number <= k_max_scans) return;
    std::snprintf(reader->message_, sizeof reader->message_, "more than %d scans", k_max_scans);
    std::longjmp(reader->jump_, 1);
  }

  const ImageBytes& image_;
  jpeg_decompress_struct info_{};
  jpeg_error_mgr errors_{};
  jpeg_progress_mgr progress_{};
  std::jmp_buf jump_{};
  char message_[JMSG_LENGTH_MAX] = {};
};

}  // namespace

Texels decode_jpeg(const ImageBytes& image) { return JpegReader(image).read(); }

}  // namespace gradslc
