#pragma once
// Scenes as text for the loader's tests.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <variant>

#include "core/error.h"
#include "scene/loaders/loader.h"

namespace gradslc::test {

constexpr std::string_view k_sensor = R"(<sensor type="perspective"><float name="fov" value="40"/></sensor>)";

inline SceneDescription load(std::string_view body, const LoadOptions& options = {},
                             std::string_view version = "3.0.0") {
  return load_scene_text(fmt::format("<scene version=\"{}\">\n{}\n{}</scene>", version, body, k_sensor), "test.xml",
                         options);
}

/// The whole text of the error that loading raises. `body` begins on line 2.
inline std::string refusal(std::string_view body, const LoadOptions& options = {}, std::string_view version = "3.0.0") {
  try {
    load(body, options, version);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    const std::string text = error.what();
    return text.substr(0, text.find('\n'));
  }
  return "accepted";
}

/// Colour of a material as seen from its front.
inline Rgb reflectance(const MaterialPtr& material) {
  Shading shading;
  material->shade({}, {0, 0, 1}, shading);
  return shading.bsdf.albedo();
}

inline bool is_two_sided(const MaterialPtr& material) {
  Shading shading;
  material->shade({}, {0, 0, -1}, shading);
  return shading.frame.n.z < 0;
}

/// Files in a folder of their own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() /
              fmt::format("gradslc-loader-{}", testing::UnitTest::GetInstance()->random_seed())) {
    path_ += testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(path_ / "parts");
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, std::string_view content) const {
    std::ofstream(path_ / name) << content;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

}  // namespace gradslc::test
