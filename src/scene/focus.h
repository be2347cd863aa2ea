#pragma once

#include "scene/light.h"

namespace gradslc {

class Scene;

/// A ball around what the camera sees first: centre at the median of its points, half as wide again as to hold nine
/// tenths of them. Radius 0 where it sees next to nothing, or where that is as large as the scene. From a fixed grid of
/// pixels: the same for every method and seed.
BoundingSphere find_focus(const Scene& scene);

}  // namespace gradslc
