#pragma once

#include <filesystem>
#include <string>

namespace gradslc {

class Scene;

/// SHA-256 over what a scene looks like to an integrator: the bytes of its file, all meshes, the camera's rays, the
/// emitted power, and every material's name, sides and albedo on a grid of texture coordinates. So a changed mesh,
/// include or texture gives another hash even if the scene file's own bytes are the same.
std::string scene_hash(const Scene& scene, const std::filesystem::path& file);

}  // namespace gradslc
