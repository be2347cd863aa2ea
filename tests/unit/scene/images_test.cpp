#include "scene/loaders/images.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <random>

#include <jpeglib.h>

#include "core/error.h"
#include "core/exr.h"
#include "core/file.h"
#include "support/temporary_folder.h"
#include "unit/scene/image_bytes.h"

namespace gradslc {
namespace {

using fixtures::TemporaryFolder;
using namespace std::string_literals;

using Bytes = std::vector<std::uint8_t>;

/// The message of the error that decoding raises; empty where it raises none.
std::string refusal(const std::string& bytes) {
  try {
    decode_image(bytes, "image.file");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_EQ(error.where().file, "image.file");
    EXPECT_EQ(error.message().find('\n'), std::string::npos);
    return error.message();
  }
  return "";
}

template <class Value>
void expect_image(const std::string& bytes, Resolution resolution, int channels, const std::vector<Value>& values) {
  const Texels texels = decode_image(bytes, "image.file");
  EXPECT_EQ(texels.resolution, resolution);
  EXPECT_EQ(texels.channels, channels);
  ASSERT_TRUE(std::holds_alternative<std::vector<Value>>(texels.values));
  EXPECT_EQ(std::get<std::vector<Value>>(texels.values), values);
}

/// Every truncation must be an error, and flipped bytes an error or an image.
void expect_robust(const std::string& whole, std::size_t needed) {
  ASSERT_EQ(refusal(whole), "");
  for (std::size_t size = 0; size < needed; ++size)
    EXPECT_NE(refusal(whole.substr(0, size)), "") << size << " of " << whole.size() << " bytes";
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    std::string damaged = whole;
    for (int flip = 0; flip <= trial % 3; ++flip) damaged[random() % damaged.size()] = static_cast<char>(random());
    refusal(damaged);
  }
}
void expect_robust(const std::string& whole) { expect_robust(whole, whole.size()); }

const std::string k_colour_png = test::png(2, 2, 8, 2, "\0\x01\x02\x03\x04\x05\x06\0\x07\x08\x09\xff\xfe\xfd"s);

TEST(Images, ReadPngOfEveryKind) {
  expect_image<std::uint8_t>(k_colour_png, {2, 2}, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 255, 254, 253});
  expect_image<std::uint8_t>(test::png(3, 1, 8, 0, "\0\x01\x80\xff"s), {3, 1}, 1, {1, 128, 255});
  expect_image<std::uint8_t>(test::png(5, 1, 1, 0, "\0\xa8"s), {5, 1}, 1, {255, 0, 255, 0, 255});
  expect_image<std::uint8_t>(test::png(1, 2, 8, 6, "\0\x01\x02\x03\x04\0\x05\x06\x07\x08"s), {1, 2}, 4,
                             {1, 2, 3, 4, 5, 6, 7, 8});
  expect_image<std::uint8_t>(test::png(2, 1, 8, 4, "\0\x01\x02\x03\x04"s), {2, 1}, 2, {1, 2, 3, 4});
  const std::string palette = test::png_chunk("PLTE", "\x0a\x0b\x0c\x14\x15\x16"s);
  expect_image<std::uint8_t>(test::png(3, 1, 8, 3, "\0\x01\0\x01"s, palette), {3, 1}, 3,
                             {20, 21, 22, 10, 11, 12, 20, 21, 22});
  expect_image<std::uint16_t>(test::png(2, 1, 16, 0, "\0\x01\x02\xff\xfe"s), {2, 1}, 1, {0x0102, 0xfffe});
}

TEST(Images, LeaveTheGammaOfPngFilesOut) {
  const std::string gamma = test::png_chunk("gAMA", test::big_endian(100000));
  expect_image<std::uint8_t>(test::png(1, 1, 8, 0, "\0\x40"s, gamma), {1, 1}, 1, {0x40});
}

TEST(Images, RefuseDamagedPng) {
  expect_robust(k_colour_png);
  std::string wrong_sum = k_colour_png;
  wrong_sum[wrong_sum.find("IDAT") + 20] ^= 1;
  EXPECT_NE(refusal(wrong_sum).find("is no readable PNG file"), std::string::npos);
}

/// A JPEG file of 16 x 24 pixels, the left half of one colour and the right half of another.
std::string jpeg(int components, const std::vector<jpeg_scan_info>& scans) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &memory, &size);
  info.image_width = 16;
  info.image_height = 24;
  info.input_components = components;
  info.in_color_space = components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 100, TRUE);
  info.comp_info[0].h_samp_factor = info.comp_info[0].v_samp_factor = 1;
  info.scan_info = scans.empty() ? nullptr : scans.data();
  info.num_scans = static_cast<int>(scans.size());
  jpeg_start_compress(&info, TRUE);
  Bytes row;
  for (int x = 0; x < 16; ++x)
    for (int c = 0; c < components; ++c) row.push_back(static_cast<std::uint8_t>(x < 8 ? 200 - 50 * c : 30 + 40 * c));
  for (JSAMPROW rows = row.data(); info.next_scanline < info.image_height;) jpeg_write_scanlines(&info, &rows, 1);
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  const std::string bytes(reinterpret_cast<const char*>(memory), size);
  std::free(memory);
  return bytes;
}

std::string jpeg(int components, bool progressive) {
  std::vector<jpeg_scan_info> scans;
  for (int c = 0; progressive && c < components; ++c) {
    scans.push_back({1, {c}, 0, 0, 0, 0});
    scans.push_back({1, {c}, 1, 63, 0, 1});
    scans.push_back({1, {c}, 1, 63, 1, 0});
  }
  return jpeg(components, scans);
}

TEST(Images, ReadJpeg) {
  for (const int components : {1, 3})
    for (const bool progressive : {false, true}) {
      const Texels texels = decode_image(jpeg(components, progressive), "image.jpg");
      EXPECT_EQ(texels.resolution, (Resolution{16, 24}));
      ASSERT_EQ(texels.channels, components);
      const auto& values = std::get<Bytes>(texels.values);
      ASSERT_EQ(values.size(), static_cast<std::size_t>(16 * 24 * components));
      for (std::size_t i = 0; i < values.size(); ++i) {
        const int x = static_cast<int>(i) / components % 16, c = static_cast<int>(i) % components;
        EXPECT_NEAR(values[i], x < 8 ? 200 - 50 * c : 30 + 40 * c, 2);
      }
    }
}

TEST(Images, RefuseDamagedJpeg) {
  for (const bool progressive : {false, true}) {
    const std::string whole = jpeg(3, progressive);
    expect_robust(whole, whole.size() - 2);
    EXPECT_NE(refusal(whole.substr(0, whole.size() / 2)).find("is no readable JPEG file: Premature end"),
              std::string::npos);
  }
}

/// Each coefficient on its own, bit by bit: 568 scans.
std::vector<jpeg_scan_info> many_scans() {
  std::vector<jpeg_scan_info> scans = {{1, {0}, 0, 0, 0, 0}};
  for (int coefficient = 1; coefficient < 64; ++coefficient) {
    scans.push_back({1, {0}, coefficient, coefficient, 0, 8});
    for (int bit = 7; bit >= 0; --bit) scans.push_back({1, {0}, coefficient, coefficient, bit + 1, bit});
  }
  return scans;
}

TEST(Images, RefuseJpegWithEndlessScans) {
  const std::vector<jpeg_scan_info> scans = many_scans();
  EXPECT_EQ(refusal(jpeg(1, scans)), "is no readable JPEG file: more than 500 scans");
  EXPECT_EQ(refusal(jpeg(1, {scans.begin(), scans.begin() + 450})), "");
}

const std::string k_pixels = "\x03\x02\x01\x06\x05\x04\x09\x08\x07\x0c\x0b\x0a"s;  // blue, green, red

TEST(Images, ReadTgaOfEveryKind) {
  expect_image<std::uint8_t>(test::tga(2, 2, 2, 24, 0x20, k_pixels), {2, 2}, 3,
                             {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  expect_image<std::uint8_t>(test::tga(2, 2, 2, 24, 0, k_pixels), {2, 2}, 3, {7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6});
  expect_image<std::uint8_t>(test::tga(2, 2, 2, 24, 0x30, k_pixels), {2, 2}, 3,
                             {4, 5, 6, 1, 2, 3, 10, 11, 12, 7, 8, 9});
  expect_image<std::uint8_t>(test::tga(2, 1, 1, 32, 0x28, "\x03\x02\x01\x80"s), {1, 1}, 4, {1, 2, 3, 128});
  expect_image<std::uint8_t>(test::tga(2, 1, 1, 16, 0x20, test::little_endian(31u << 10 | 1u, 2)), {1, 1}, 3,
                             {255, 0, 8});
  expect_image<std::uint8_t>(test::tga(3, 2, 1, 8, 0x20, "\x07\x09"s), {2, 1}, 1, {7, 9});
  expect_image<std::uint8_t>(test::tga(1, 3, 1, 8, 0x20, k_pixels.substr(0, 6) + "\x01\0\x01"s, 2, 24), {3, 1}, 3,
                             {4, 5, 6, 1, 2, 3, 4, 5, 6});
  // Three times one pixel across two rows, then one as it is.
  expect_image<std::uint8_t>(test::tga(10, 2, 2, 24, 0x20, "\x82\x03\x02\x01\0\x0c\x0b\x0a"s), {2, 2}, 3,
                             {1, 2, 3, 1, 2, 3, 1, 2, 3, 10, 11, 12});
}

TEST(Images, RefuseDamagedTga) {
  expect_robust(test::tga(2, 2, 2, 24, 0x20, k_pixels));
  expect_robust(test::tga(10, 2, 2, 24, 0x20, "\x82\x03\x02\x01\0\x0c\x0b\x0a"s));
  EXPECT_EQ(refusal(test::tga(1, 1, 1, 8, 0x20, k_pixels.substr(0, 6) + "\x02"s, 2, 24)),
            "is damaged: colour 2 is not in its colour map");
  EXPECT_EQ(refusal(test::tga(2, 2, 2, 24, 0x20, k_pixels.substr(1))), "is truncated: ends after 29 bytes");
}

TEST(Images, ReadBmp) {
  const std::string rows = "\x03\x02\x01\x06\x05\x04\0\0\x09\x08\x07\x0c\x0b\x0a\0\0"s;
  expect_image<std::uint8_t>(test::bmp(2, 2, 24, rows), {2, 2}, 3, {7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6});
  expect_image<std::uint8_t>(test::bmp(2, -2, 24, rows), {2, 2}, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  expect_image<std::uint8_t>(test::bmp(1, 1, 32, "\x03\x02\x01\xff"s), {1, 1}, 3, {1, 2, 3});
  const std::string palette = "\x03\x02\x01\0\x06\x05\x04\0"s;
  expect_image<std::uint8_t>(test::bmp(3, 1, 1, palette + "\xa0\0\0\0"s, 8), {3, 1}, 3, {4, 5, 6, 1, 2, 3, 4, 5, 6});
}

TEST(Images, RefuseDamagedBmp) {
  expect_robust(test::bmp(1, 1, 24, "\x03\x02\x01\0"s));
  const std::string palette(16 * 4, '\x05');
  expect_robust(test::bmp(3, 1, 4, palette + "\x12\x30\0\0"s, 64));
  EXPECT_EQ(refusal(test::bmp(0, 1, 24, "")), "is damaged: the image has no pixels");
}

TEST(Images, ReadHdr) {
  // Mantissa times 2^(exponent - 136).
  const std::string three = "\x80\x40\0\x81\0\0\0\0\x01\x02\x03\x88"s;
  const std::vector<float> values = {1, 0.5f, 0, 0, 0, 0, 1, 2, 3};
  expect_image<float>(test::hdr("-Y 1 +X 3", three), {3, 1}, 3, values);
  expect_image<float>(test::hdr("-Y 3 +X 1", three), {1, 3}, 3, values);
  // Eight pixels: red a run of 8, green 8 as they are, blue two runs, one exponent.
  const std::string runs = "\x02\x02\0\x08\x88\x80\x08\x01\x02\x03\x04\x05\x06\x07\x08\x83\x10\x85\x20\x88\x88"s;
  std::vector<float> eight;
  for (int x = 0; x < 8; ++x) eight.insert(eight.end(), {128, static_cast<float>(x + 1), x < 3 ? 16.0f : 32.0f});
  expect_image<float>(test::hdr("-Y 1 +X 8", runs), {8, 1}, 3, eight);
  // The old way: one pixel, repeated twice.
  expect_image<float>(test::hdr("-Y 1 +X 3", "\x01\x02\x03\x88\x01\x01\x01\x02"s), {3, 1}, 3,
                      {1, 2, 3, 1, 2, 3, 1, 2, 3});
}

TEST(Images, RefuseDamagedHdr) {
  expect_robust(test::hdr("-Y 1 +X 3", "\x80\x40\0\x81\0\0\0\0\x01\x02\x03\x88"s));
  expect_robust(test::hdr("-Y 1 +X 8", "\x02\x02\0\x08\x88\x80\x88\x01\x83\x10\x85\x20\x88\x88"s));
  EXPECT_EQ(refusal(test::hdr("-Y 1 +X 8", "\x02\x02\0\x08\x89\x80"s)), "is damaged: a run is longer than its line");
  EXPECT_EQ(refusal(test::hdr("-Y 1 +X 3", "\x01\x01\x01\x02"s)), "is damaged: a run without a pixel to repeat");
  EXPECT_EQ(refusal(test::hdr("+Y 1 +X 3", "")), "is an HDR file whose size is not given as \"-Y height +X width\"");
  EXPECT_NE(refusal("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234"), "");
}

TEST(Images, ReadExr) {
  const TemporaryFolder folder;
  RgbImage image({2, 1});
  image(0, 0) = {0.25f, 1000, -2};
  write_exr(folder.path() / "image.exr", {.image = image, .layers = {}, .attributes = {}});
  expect_image<float>(read_file(folder.path() / "image.exr"), {2, 1}, 3, {0.25f, 1000, -2, 0, 0, 0});
  image(1, 0).g = std::numeric_limits<float>::quiet_NaN();
  write_exr(folder.path() / "image.exr", {.image = image, .layers = {}, .attributes = {}});
  EXPECT_EQ(refusal(read_file(folder.path() / "image.exr")), "has pixels that are no finite numbers");
}

TEST(Images, HugeHeadersTakeNoMemory) {
  EXPECT_EQ(refusal(test::png(60000, 60000, 16, 6, "\0"s)).substr(0, 55),
            "is damaged: its header asks for 60000 x 60000 pixels, m");
  EXPECT_EQ(refusal(test::png(70000, 1, 8, 0, "\0"s)),
            "the image has 70000 x 1 pixels; at most 65536 x 65536 are supported");
  EXPECT_NE(refusal(test::tga(2, 65535, 65535, 32, 0, "")), "");
  EXPECT_NE(refusal(test::bmp(65536, -65536, 24, "")), "");
  EXPECT_NE(refusal(test::bmp(1, std::numeric_limits<int>::min(), 24, "")), "");
  EXPECT_NE(refusal(test::hdr("-Y 65536 +X 65536", "")), "");
  EXPECT_NE(refusal(test::hdr("-Y 4294967296 +X 1", "")), "");
  std::string wide = jpeg(3, true);
  const std::size_t frame = wide.find("\xff\xc2");
  wide.replace(frame + 5, 4, "\xea\x60\xea\x60");
  EXPECT_EQ(refusal(wide).substr(0, 55), "is damaged: its header asks for 60000 x 60000 pixels, m");
}

TEST(Images, RefuseWhatIsNone) {
  for (const std::string& bytes : {""s, "x"s, "GIF89a"s + std::string(40, '\1'), "II*\0"s + std::string(40, '\2')})
    EXPECT_EQ(refusal(bytes), "is no image of a known format; known: png, jpg, tga, bmp, hdr, exr");
  EXPECT_THROW(read_image("no-such-folder/image.png"), Error);
}

TEST(Images, ReadFiles) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_image(folder.write("wrong name.jpg", k_colour_png)).resolution, (Resolution{2, 2}));
}

}  // namespace
}  // namespace gradslc
