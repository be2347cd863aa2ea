#pragma once

#include <array>
#include <optional>

#include "core/vec.h"

namespace gradslc {

/// An affine map of space, p' = A p + t; double, rounded to float where it is applied.
class Transform {
 public:
  Transform() = default;  ///< identity
  /// Row-major 3x4.
  explicit Transform(const std::array<std::array<double, 4>, 3>& rows) : rows_(rows) {}

  static Transform translation(double x, double y, double z);
  static Transform scaling(double x, double y, double z);
  /// By `degrees` around an axis, right-handed; the axis must not be zero.
  static Transform rotation(double x, double y, double z, double degrees);
  /// Camera at `origin`, +z towards `target`, +y near `up`, +x to the left (Mitsuba's convention).
  /// nullopt where the direction is zero or parallel to `up`.
  static std::optional<Transform> look_at(Point3 origin, Point3 target, Vec3 up);

  /// First `inner`, then this.
  Transform operator*(const Transform& inner) const;

  Point3 apply(Point3 p) const;
  Vec3 apply(Vec3 v) const;
  /// By the inverse transpose, normalised; zero where the map is singular there.
  Normal3 apply(Normal3 n) const;

  Vec3 column(int index) const;
  double determinant() const;
  bool is_finite() const;

 private:
  std::array<std::array<double, 4>, 3> rows_{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
};

}  // namespace gradslc
