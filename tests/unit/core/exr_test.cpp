#include "core/exr.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/file.h"
#include "core/parallel.h"
#include "unit/core/exr_bytes.h"

namespace gradslc {
namespace {

namespace fs = std::filesystem;

class Exr : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("gradslc_exr_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path file(const std::string& name = "image.exr") const { return folder_ / name; }
  fs::path file_of(const std::string& bytes) const {
    write_file_atomically(file(), bytes);
    return file();
  }

 private:
  fs::path folder_;
};

bool same_bits(const RgbImage& a, const RgbImage& b) {
  return a.resolution() == b.resolution() && std::memcmp(&a[0], &b[0], a.size() * sizeof(Rgb)) == 0;
}

RgbImage random_image(Resolution resolution, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  RgbImage image(resolution);
  for (Rgb& pixel : image) pixel = {uniform(random), 100 * uniform(random), 1e-6f * uniform(random)};
  return image;
}

ExrImage sample_content() {
  constexpr Resolution resolution{37, 19};
  ExrImage content{.image = random_image(resolution, 1), .layers = {}, .attributes = {}};
  content.image(0, 0) = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), -0.0f};
  content.image(1, 0) = {std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max(), 1.0f / 3};
  content.layers["dx"] = random_image(resolution, 2);
  content.layers["a layer with a long name.and a dot"] = random_image(resolution, 3);
  Image<float> count(resolution);
  for (std::size_t i = 0; i < count.size(); ++i) count[i] = static_cast<float>(i);
  content.layers["primal_count"] = count;
  content.attributes["manifest"] = R"({"seed": 1, "name": "é"})" + std::string(100000, ' ');
  content.attributes["empty"] = "";
  return content;
}

TEST_F(Exr, GivesBackWhatWasWrittenBitByBit) {
  const ExrImage content = sample_content();
  write_exr(file(), content);
  const ExrImage back = read_exr(file());
  EXPECT_TRUE(same_bits(back.image, content.image));
  ASSERT_EQ(back.layers.size(), content.layers.size());
  for (const auto& [name, layer] : content.layers) EXPECT_EQ(back.layers.at(name), layer) << name;
  EXPECT_EQ(back.attributes, content.attributes);
}

TEST_F(Exr, BytesDoNotDependOnTheNumberOfThreads) {
  const ExrImage content = sample_content();
  set_thread_count(1);
  write_exr(file("one.exr"), content);
  set_thread_count(7);
  write_exr(file("seven.exr"), content);
  set_thread_count(0);
  EXPECT_EQ(read_file(file("one.exr")), read_file(file("seven.exr")));
}

TEST_F(Exr, ReplacesAFileAndLeavesNothingElse) {
  write_file_atomically(file(), "old");
  write_exr(file(), sample_content());
  EXPECT_NO_THROW(read_exr(file()));
  EXPECT_EQ(std::distance(fs::directory_iterator(file().parent_path()), fs::directory_iterator()), 1);
}

std::uint32_t float_bits(float value) { return std::bit_cast<std::uint32_t>(value); }
float test_value(const std::string& channel, int x, int y) {
  return static_cast<float>(100 * x + 10 * y) + static_cast<float>(channel.back() - 'A');
}
std::uint32_t test_bits(const std::string& channel, int x, int y) { return float_bits(test_value(channel, x, y)); }
Rgb test_pixel(int x, int y, const std::string& prefix = "") {
  return {test_value(prefix + "R", x, y), test_value(prefix + "G", x, y), test_value(prefix + "B", x, y)};
}

TEST_F(Exr, ReadsABytewiseOracle) {
  const RgbImage image = read_exr(file_of(ExrBytes{}.build(test_bits))).image;
  ASSERT_EQ(image.resolution(), (Resolution{2, 2}));
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) EXPECT_EQ(image(x, y), test_pixel(x, y));
}

TEST_F(Exr, ReadsHalfChannels) {
  const auto bits = [](const std::string& channel, int, int) -> std::uint32_t {
    return channel == "R" ? 0x3c00 : channel == "G" ? 0xc000 : 0x3555;  // 1, -2, about 1/3
  };
  const RgbImage image = read_exr(file_of(ExrBytes{.type = ExrBytes::Type::half}.build(bits))).image;
  for (const Rgb& pixel : image) EXPECT_EQ(pixel, Rgb(1, -2, 0.333251953125f));
}

TEST_F(Exr, ReadsTiles) {
  const ExrBytes bytes{.data = {0, 0, 4, 2}, .display = {0, 0, 4, 2}, .tiled = true};
  const RgbImage image = read_exr(file_of(bytes.build(test_bits))).image;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) EXPECT_EQ(image(x, y), test_pixel(x, y));
}

/// Display window (2..5, -1..2); data windows inside it, reaching beyond it, and apart from it.
TEST_F(Exr, ImageIsTheDisplayWindow) {
  const ExrBytes::Window display{2, -1, 5, 2};
  for (const ExrBytes::Window data : {ExrBytes::Window{3, 0, 4, 2}, {-7, -8, 9, 10}, {4, 1, 9, 9}, {20, 20, 21, 21}}) {
    const ExrBytes bytes{.data = data, .display = display, .channels = {"B", "G", "R", "n.Y"}};
    const ExrImage exr = read_exr(file_of(bytes.build(test_bits)));
    ASSERT_EQ(exr.image.resolution(), (Resolution{4, 4}));
    const auto& grey = std::get<Image<float>>(exr.layers.at("n"));
    for (int y = display.y_min; y <= display.y_max; ++y)
      for (int x = display.x_min; x <= display.x_max; ++x) {
        const bool inside = x >= data.x_min && x <= data.x_max && y >= data.y_min && y <= data.y_max;
        EXPECT_EQ(exr.image(x - 2, y + 1), inside ? test_pixel(x, y) : Rgb(0)) << x << "," << y;
        EXPECT_EQ(grey(x - 2, y + 1), inside ? test_value("n.Y", x, y) : 0) << x << "," << y;
      }
  }
}

TEST_F(Exr, LeavesOtherChannelsOut) {
  const ExrBytes bytes{.channels = {"A", "B", "G", "R", "Y", "Z", "half.G", "n.B", "n.G", "n.R", "n.X"}};
  const ExrImage exr = read_exr(file_of(bytes.build(test_bits)));
  ASSERT_EQ(exr.layers.size(), 1u);
  EXPECT_EQ(std::get<RgbImage>(exr.layers.at("n"))(1, 1), test_pixel(1, 1, "n."));
}

/// The message of the Error (input) that reading throws; "" where it throws none.
std::string input_error(const fs::path& path) {
  try {
    read_exr(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_EQ(error.where().file, path.string());
    return error.message();
  }
  return "";
}

TEST_F(Exr, LuminanceAloneIsGrey) {
  const RgbImage image = read_exr(file_of(ExrBytes{.channels = {"Y"}}.build(test_bits))).image;
  ASSERT_EQ(image.resolution(), (Resolution{2, 2}));
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) EXPECT_EQ(image(x, y), Rgb(test_value("Y", x, y)));
}

/// The same for a file's content.
std::string decoding_error(const std::string& bytes) {
  try {
    decode_exr(bytes, "image.exr");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_EQ(error.where().file, "image.exr");
    return error.message();
  }
  return "";
}

TEST_F(Exr, MissingChannelsAreAnErrorThatNamesThoseThatExist) {
  const std::string message = input_error(file_of(ExrBytes{.channels = {"B", "R", "depth.Z"}}.build(test_bits)));
  EXPECT_EQ(message, "has no channel G; R, G and B, or Y, are needed, there are: B, R, depth.Z");
}

TEST_F(Exr, SubsampledChannelsAreAnError) {
  EXPECT_NE(input_error(file_of(ExrBytes{.sampling = 2}.build(test_bits))), "");
}

TEST_F(Exr, MissingFileAndOtherFormatsAreErrors) {
  EXPECT_NE(input_error(file("nowhere.exr")), "");
  EXPECT_NE(input_error(file().parent_path()), "");
  EXPECT_NE(input_error(file_of("")), "");
  EXPECT_NE(input_error(file_of("PF\n2 2\n-1.0\n" + std::string(48, 'x'))), "");
}

TEST_F(Exr, HugeWindowsOfDamagedHeadersTakeNoMemory) {
  const std::string small = ExrBytes{.display = {0, 0, 99999, 99999}}.build(test_bits);
  EXPECT_NE(input_error(file_of(small)).find("is damaged"), std::string::npos);
  std::string wide = ExrBytes{}.build(test_bits);
  const std::size_t x_max = wide.find("box2i") + 6 + 4 + 8;
  const std::int32_t huge = 1 << 29;
  std::memcpy(&wide[x_max], &huge, sizeof huge);
  EXPECT_NE(input_error(file_of(wide)), "");
}

TEST_F(Exr, EveryTruncationIsAnError) {
  ExrImage content{.image = random_image({9, 40}, 4), .layers = {}, .attributes = {{"manifest", "{}"}}};
  write_exr(file(), content);
  const std::string whole = read_file(file());
  for (std::size_t size = 0; size < whole.size(); size += size < 700 ? 1 : 37)
    EXPECT_NE(decoding_error(whole.substr(0, size)), "") << size << " of " << whole.size() << " bytes";
}

/// Flipped bytes either give an Error or some image of a plausible size; never a crash.
TEST_F(Exr, DamagedBytesNeverCrash) {
  write_exr(file(), {.image = random_image({9, 40}, 4), .layers = {}, .attributes = {{"manifest", "{}"}}});
  const std::string whole = read_file(file());
  std::mt19937 random(1);
  int errors = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::string damaged = whole;
    const std::size_t reach = trial % 2 == 0 ? std::size_t{500} : damaged.size();  // the header, or anywhere
    for (int flip = 0; flip <= trial % 4; ++flip) damaged[random() % reach] = static_cast<char>(random());
    errors += decoding_error(damaged).empty() ? 0 : 1;
  }
  EXPECT_GT(errors, 100);
}

TEST_F(Exr, UnwritableFolderIsAnError) {
  write_file_atomically(file("plain"), "not a folder");
  EXPECT_THROW(write_exr(file("plain") / "image.exr", sample_content()), Error);
  EXPECT_THROW(write_exr(file(), ExrImage{}), Error);
  EXPECT_FALSE(fs::exists(file()));
}

}  // namespace
}  // namespace gradslc
