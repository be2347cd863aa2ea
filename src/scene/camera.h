#pragma once

#include "core/image.h"
#include "core/ray.h"
#include "core/vec.h"
#include "core/warp.h"

namespace gradslc {

/// The part of the plane at distance 1 before a camera that its image shows: x to the right and y up from the axis.
struct ImageWindow {
  Vec2 top_left, bottom_right;
};

/// Radius and distance in scene units. Radius 0: a pinhole.
struct ThinLens {
  float radius = 0;
  float focus_distance = 1;  ///< from the lens, along the axis, to the plane that is sharp; above 0
};

/// A perspective camera with a pinhole or a thin lens. Looks along `forward`; `right` and `up` span the image plane.
/// Mitsuba's convention: the camera looks along +z of its own space, +x points to the left of the image.
class PerspectiveCamera {
 public:
  PerspectiveCamera() = default;
  /// The three axes are unit and orthogonal.
  PerspectiveCamera(Resolution resolution, Point3 position, Vec3 forward, Vec3 right, Vec3 up,
                    const ImageWindow& window, const ThinLens& lens = {})
      : resolution_(resolution),
        position_(position),
        forward_(forward),
        right_(right),
        up_(up),
        window_(window),
        lens_(lens) {}
  /// The axis meets the image's middle; `tan_half_x` and `tan_half_y` are half the window's extent.
  PerspectiveCamera(Resolution resolution, Point3 position, Vec3 forward, Vec3 right, Vec3 up, float tan_half_x,
                    float tan_half_y)
      : PerspectiveCamera(resolution, position, forward, right, up,
                          ImageWindow{{-tan_half_x, tan_half_y}, {tan_half_x, -tan_half_y}}) {}

  Resolution resolution() const { return resolution_; }
  Point3 position() const { return position_; }
  Vec3 forward() const { return forward_; }
  const ThinLens& lens() const { return lens_; }
  /// Whether rays depend on `u_lens`.
  bool has_lens() const { return lens_.radius > 0; }

  /// The ray through a film position: (0,0) is the image's top left corner, (width, height) its bottom right one.
  /// `u_lens` in [0,1)^2 chooses the point of the lens, uniformly; its default is the middle.
  /// The ray's weight is 1: a pixel's value is the mean radiance over its area (box filter) and the lens.
  Ray generate_ray(Vec2 film_position, Vec2 u_lens = {0.5f, 0.5f}) const {
    const float s = film_position.x / static_cast<float>(resolution_.width);
    const float t = film_position.y / static_cast<float>(resolution_.height);
    const float x = (1 - s) * window_.top_left.x + s * window_.bottom_right.x;
    const float y = (1 - t) * window_.top_left.y + t * window_.bottom_right.y;
    const Vec3 through_middle = forward_ + x * right_ + y * up_;
    if (!has_lens()) return {position_, normalize(through_middle)};
    const Vec2 disk = square_to_disk(u_lens);
    const Vec3 on_lens = lens_.radius * (disk.x * right_ + disk.y * up_);
    return {position_ + on_lens, normalize(lens_.focus_distance * through_middle - on_lens)};
  }

 private:
  Resolution resolution_;
  Point3 position_;
  Vec3 forward_{0, 0, 1}, right_{-1, 0, 0}, up_{0, 1, 0};
  ImageWindow window_{{-1, 1}, {1, -1}};
  ThinLens lens_;
};

}  // namespace gradslc
