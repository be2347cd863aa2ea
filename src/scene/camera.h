#pragma once

#include "core/image.h"
#include "core/ray.h"
#include "core/vec.h"

namespace gradslc {

/// A pinhole camera. Looks along `forward`; `right` and `up` span the image plane.
/// Mitsuba's convention: the camera looks along +z of its own space, +x points to the left of the image.
class PerspectiveCamera {
 public:
  PerspectiveCamera() = default;
  /// The three axes are unit and orthogonal; `tan_half_x` and `tan_half_y` are half the image plane's extent at
  /// distance 1.
  PerspectiveCamera(Resolution resolution, Point3 position, Vec3 forward, Vec3 right, Vec3 up, float tan_half_x,
                    float tan_half_y)
      : resolution_(resolution),
        position_(position),
        forward_(forward),
        right_(right),
        up_(up),
        tan_half_x_(tan_half_x),
        tan_half_y_(tan_half_y) {}

  Resolution resolution() const { return resolution_; }
  Point3 position() const { return position_; }
  Vec3 forward() const { return forward_; }

  /// The ray through a film position: (0,0) is the image's top left corner, (width, height) its bottom right one.
  /// Its weight is 1: a pixel's value is the mean radiance over its area (box filter).
  Ray generate_ray(Vec2 film_position) const {
    const float x = 2 * film_position.x / static_cast<float>(resolution_.width) - 1;
    const float y = 1 - 2 * film_position.y / static_cast<float>(resolution_.height);
    return {position_, normalize(forward_ + (x * tan_half_x_) * right_ + (y * tan_half_y_) * up_)};
  }

 private:
  Resolution resolution_;
  Point3 position_;
  Vec3 forward_{0, 0, 1}, right_{-1, 0, 0}, up_{0, 1, 0};
  float tan_half_x_ = 1, tan_half_y_ = 1;
};

}  // namespace gradslc
