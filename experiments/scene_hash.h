#pragma once

#include <string>

namespace gradslc {

class Scene;

/// SHA-256 over the bytes of all files that the scene was read from, all meshes, the emitted power and the camera's
/// rays: a changed mesh, include, texture or option gives another hash even if the scene file's own bytes are the same.
std::string scene_hash(const Scene& scene);

}  // namespace gradslc
