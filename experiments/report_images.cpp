#include "experiments/report_images.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

#include "core/error.h"

namespace gradslc {
namespace {

constexpr double k_bright_quantile = 0.95;
constexpr float k_bright_level = 0.8f;

std::uint8_t encode_channel(float linear) {
  return static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(std::isnan(linear) ? 0 : linear)));
}

}  // namespace

std::string encode_png(const RgbImage& image, float exposure) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * image.size());
  for (const Rgb& pixel : image) {
    for (int c = 0; c < 3; ++c) bytes.push_back(encode_channel(exposure * pixel[c]));
  }
  std::string png;
  const auto append = [](void* target, void* data, int size) {
    static_cast<std::string*>(target)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  if (stbi_write_png_to_func(append, &png, image.width(), image.height(), 3, bytes.data(), 3 * image.width()) == 0) {
    throw_failure("", "a PNG image could not be encoded");
  }
  return png;
}

float display_exposure(const RgbImage& image) {
  std::vector<float> values;
  for (const Rgb& pixel : image) {
    if (is_finite(pixel)) values.push_back(luminance(pixel));
  }
  if (values.empty()) return 1;
  const auto bright =
      values.begin() + static_cast<std::ptrdiff_t>(k_bright_quantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), bright, values.end());
  return *bright > 0 ? k_bright_level / *bright : 1;
}

RgbImage error_image(const RgbImage& image, const RgbImage& reference) {
  double sum = 0;
  for (const Rgb& pixel : reference) sum += double{luminance(pixel)};
  const float floor = static_cast<float>(0.1 * sum / static_cast<double>(reference.size()));
  RgbImage result(image.resolution());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const float r = luminance(reference[i]);
    const float error = std::clamp((luminance(image[i]) - r) / (std::abs(r) + floor), -1.0f, 1.0f);
    const float rest = 1 - std::abs(error);
    result[i] = error > 0 ? Rgb(1, rest, rest) : Rgb(rest, rest, 1);
  }
  return result;
}

std::string base64(const std::string& bytes) {
  constexpr char k_digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? k_digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace gradslc
