#pragma once
// Runs the real executable, as a user would.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace gradslc::fixtures {

struct Outcome {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string output, errors;
};

inline std::string content_of(const std::filesystem::path& file) {
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  return content.str();
}

/// `argument` as one word of a shell command.
inline std::string quoted(const std::string& argument) {
  std::string text(1, '\'');
  for (const char c : argument) {
    if (c == '\'')
      text.append("'\\''");
    else
      text.push_back(c);
  }
  text.push_back('\'');
  return text;
}

/// gradslc with `arguments`, in `folder`.
inline Outcome run_program(const std::filesystem::path& folder, const std::vector<std::string>& arguments) {
  const TemporaryFolder elsewhere;
  const std::filesystem::path errors = elsewhere.path() / "stderr";
  std::string command =
      fmt::format("cd {} && unset GRADSLC_LOST && {}", quoted(folder.string()), quoted(GRADSLC_EXECUTABLE));
  for (const std::string& argument : arguments) command += fmt::format(" {}", quoted(argument));
  command += fmt::format(" 2>{} </dev/null", quoted(errors.string()));
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> buffer;
  while (const std::size_t read = std::fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.output.append(buffer.data(), read);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  outcome.errors = content_of(errors);
  return outcome;
}

/// A closed-in corner: floor, wall and lamp, small enough for a test.
inline const char* const k_scene = R"(<scene version="3.0.0">
  <sensor type="perspective">
    <float name="fov" value="60"/>
    <transform name="to_world"><lookat origin="0, 1, 4" target="0, 1, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/></film>
  </sensor>
  <bsdf type="diffuse" id="grey"><rgb name="reflectance" value="0.5, 0.6, 0.7"/></bsdf>
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="-90"/></transform><ref id="grey"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><translate x="0" y="1" z="-1"/></transform><ref id="grey"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><scale value="0.3"/><rotate x="1" angle="90"/><translate y="1.9"/></transform>
    <ref id="grey"/>
    <emitter type="area"><rgb name="radiance" value="8, 8, 8"/></emitter>
  </shape>
</scene>
)";

/// A folder with scene.xml (k_scene), in which the program runs.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest() { folder_.write("scene.xml", k_scene); }

  Outcome run(const std::vector<std::string>& arguments) const { return run_program(folder_.path(), arguments); }
  /// All files below the folder.
  std::vector<std::string> files() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
      found.push_back(entry.path().lexically_relative(folder_.path()).string());
    std::sort(found.begin(), found.end());
    return found;
  }

  TemporaryFolder folder_;
};

}  // namespace gradslc::fixtures
