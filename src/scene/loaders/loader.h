#pragma once

#include <map>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace gradslc {

struct LoadOptions {
  /// Replace the film's; one alone keeps the aspect ratio. A crop window scales with its film.
  std::optional<int> width, height;
  std::map<std::string, std::string> definitions;  ///< values for <default> parameters ($name), as Mitsuba's -D
  bool permissive = false;                         ///< what is not recognised becomes a note instead of an error
};

/// Loads a scene file in Mitsuba's XML format, dialect 0.5/0.6 or 3 by its version attribute.
/// Throws Error (input) with file, line, element and what would be right.
SceneDescription load_scene(const std::string& file, const LoadOptions& options = {});
/// The same for text in memory; `file` is its name in messages, and files that it names are sought in the folder of
/// that.
SceneDescription load_scene_text(std::string text, const std::string& file, const LoadOptions& options = {});

}  // namespace gradslc
