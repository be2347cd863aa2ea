#include "scene/loaders/transform.h"

#include <cmath>
#include <numbers>

namespace gradslc {
namespace {

using Double3 = std::array<double, 3>;

Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Double3& a, const Double3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
/// Zero stays zero.
Double3 normalized(const Double3& a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? Double3{a[0] / length, a[1] / length, a[2] / length} : a;
}
Double3 widen(Vec3 v) { return {v.x, v.y, v.z}; }
Vec3 narrow(const Double3& v) { return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])}; }

}  // namespace

Transform Transform::translation(double x, double y, double z) {
  return Transform({{{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}}});
}

Transform Transform::scaling(double x, double y, double z) {
  return Transform({{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}}});
}

/// Rodrigues' rotation formula.
Transform Transform::rotation(double x, double y, double z, double degrees) {
  const auto [ax, ay, az] = normalized({x, y, z});
  const double angle = degrees * std::numbers::pi / 180;
  const double s = std::sin(angle), c = std::cos(angle), k = 1 - c;
  return Transform({{{c + ax * ax * k, ax * ay * k - az * s, ax * az * k + ay * s, 0},
                     {ay * ax * k + az * s, c + ay * ay * k, ay * az * k - ax * s, 0},
                     {az * ax * k - ay * s, az * ay * k + ax * s, c + az * az * k, 0}}});
}

std::optional<Transform> Transform::look_at(Point3 origin, Point3 target, Vec3 up) {
  const Double3 o = widen(from_origin(origin)), t = widen(from_origin(target));
  const Double3 z = normalized({t[0] - o[0], t[1] - o[1], t[2] - o[2]});
  const Double3 x = normalized(cross(normalized(widen(up)), z));
  if (dot(z, z) == 0 || dot(x, x) == 0) return std::nullopt;
  const Double3 y = cross(z, x);
  return Transform({{{x[0], y[0], z[0], o[0]}, {x[1], y[1], z[1], o[1]}, {x[2], y[2], z[2], o[2]}}});
}

Transform Transform::operator*(const Transform& inner) const {
  Transform product;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      product.rows_[i][j] = j == 3 ? rows_[i][3] : 0;
      for (std::size_t k = 0; k < 3; ++k) product.rows_[i][j] += rows_[i][k] * inner.rows_[k][j];
    }
  return product;
}

Point3 Transform::apply(Point3 p) const {
  const auto row = [&](const std::array<double, 4>& r) {
    return static_cast<float>(r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]);
  };
  return {row(rows_[0]), row(rows_[1]), row(rows_[2])};
}

Vec3 Transform::apply(Vec3 v) const {
  const auto row = [&](const std::array<double, 4>& r) {
    return static_cast<float>(r[0] * v.x + r[1] * v.y + r[2] * v.z);
  };
  return {row(rows_[0]), row(rows_[1]), row(rows_[2])};
}

/// The inverse transpose is the matrix of cofactors over the determinant; its columns are cross products of A's
/// columns.
Normal3 Transform::apply(Normal3 n) const {
  const auto column3 = [&](std::size_t j) { return Double3{rows_[0][j], rows_[1][j], rows_[2][j]}; };
  const Double3 yz = cross(column3(1), column3(2)), zx = cross(column3(2), column3(0)),
                xy = cross(column3(0), column3(1));
  const double sign = determinant() < 0 ? -1 : 1;
  Double3 sum;
  for (std::size_t i = 0; i < 3; ++i) sum[i] = sign * (n.x * yz[i] + n.y * zx[i] + n.z * xy[i]);
  return as_normal(narrow(normalized(sum)));
}

Vec3 Transform::column(int index) const {
  const auto j = static_cast<std::size_t>(index);
  return narrow({rows_[0][j], rows_[1][j], rows_[2][j]});
}

double Transform::determinant() const {
  const Double3 x{rows_[0][0], rows_[1][0], rows_[2][0]}, y{rows_[0][1], rows_[1][1], rows_[2][1]},
      z{rows_[0][2], rows_[1][2], rows_[2][2]};
  return dot(x, cross(y, z));
}

bool Transform::is_finite() const {
  for (const auto& row : rows_)
    for (const double value : row)
      if (!std::isfinite(value)) return false;
  return true;
}

}  // namespace gradslc
