#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace gradslc {

/// One of the ten scenes that everything is shown on: five of ours, and the report's, which are beside the repository.
struct SceneFile {
  std::string name, file;

  bool is_real() const { return file.starts_with("scene_"); }  ///< one of the report's
  std::string label() const { return (is_real() ? "real " : "") + name; }
  /// As part of a test's name.
  std::string identifier() const {
    std::string text = (is_real() ? "real_" : "our_") + name;
    std::erase(text, '-');
    return text;
  }
  std::filesystem::path path() const {
    const std::filesystem::path root = is_real() ? GRADSLC_SHARED_DIR "/scenes" : GRADSLC_SOURCE_DIR "/scenes";
    return root / name / file;
  }
};
inline void PrintTo(const SceneFile& scene, std::ostream* stream) { *stream << scene.label(); }

inline std::vector<SceneFile> all_scenes() {
  std::vector<SceneFile> scenes;
  for (const char* name : {"cornell-box", "staircase", "bathroom", "veranda", "lamp"})
    scenes.push_back({name, "scene.xml"});
  for (const char* name : {"cornell-box", "staircase", "bathroom", "house", "lamp"})
    scenes.push_back({name, "scene_v0.6.xml"});
  return scenes;
}

}  // namespace gradslc
