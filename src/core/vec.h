#pragma once
// Vectors, points and normals: three distinct types, because they transform and combine differently.

#include <algorithm>
#include <cmath>

namespace gradslc {

struct Vec2 {
  float x = 0, y = 0;
  bool operator==(const Vec2&) const = default;
};
constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vec2 operator*(Vec2 a, float s) { return {a.x * s, a.y * s}; }
constexpr Vec2 operator*(float s, Vec2 a) { return a * s; }

/// A direction or displacement. What is called for each vertex of a path, and not inlined, takes it by reference: by
/// value it goes in two registers, which g++ fills by way of memory and waits for.
struct Vec3 {
  float x = 0, y = 0, z = 0;
  constexpr float operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  bool operator==(const Vec3&) const = default;
};
constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Vec3 operator*(float s, Vec3 a) { return a * s; }
constexpr Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
constexpr float length_squared(Vec3 a) { return dot(a, a); }
inline float length(Vec3 a) { return std::sqrt(length_squared(a)); }
/// `a` must not be zero.
inline Vec3 normalize(Vec3 a) { return a / length(a); }
/// The mirror image of `v` at a plane of unit normal `n`, on the same side.
constexpr Vec3 mirrored(Vec3 v, Vec3 n) { return 2 * dot(v, n) * n - v; }
constexpr float max_component(Vec3 a) { return std::max(a.x, std::max(a.y, a.z)); }
inline Vec3 abs(Vec3 a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }

/// A position in space.
struct Point3 {
  float x = 0, y = 0, z = 0;
  constexpr float operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  bool operator==(const Point3&) const = default;
};
constexpr Vec3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Point3 operator+(Point3 p, Vec3 v) { return {p.x + v.x, p.y + v.y, p.z + v.z}; }
constexpr Point3 operator-(Point3 p, Vec3 v) { return {p.x - v.x, p.y - v.y, p.z - v.z}; }
constexpr float distance_squared(Point3 a, Point3 b) { return length_squared(a - b); }
inline float distance(Point3 a, Point3 b) { return length(a - b); }
constexpr Point3 min(Point3 a, Point3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
constexpr Point3 max(Point3 a, Point3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
constexpr Vec3 from_origin(Point3 p) { return {p.x, p.y, p.z}; }

/// A surface normal, unit length unless said otherwise; transforms with the inverse transpose.
struct Normal3 {
  float x = 0, y = 0, z = 1;
  bool operator==(const Normal3&) const = default;
};
constexpr Vec3 as_vec(Normal3 n) { return {n.x, n.y, n.z}; }
constexpr Normal3 as_normal(Vec3 v) { return {v.x, v.y, v.z}; }
constexpr Normal3 operator-(Normal3 n) { return {-n.x, -n.y, -n.z}; }
constexpr float dot(Normal3 n, Vec3 v) { return dot(as_vec(n), v); }
constexpr float dot(Vec3 v, Normal3 n) { return dot(v, as_vec(n)); }
constexpr float dot(Normal3 a, Normal3 b) { return dot(as_vec(a), as_vec(b)); }

/// The normal on the side of `v`.
constexpr Normal3 face_forward(Normal3 n, Vec3 v) { return dot(n, v) < 0 ? -n : n; }

}  // namespace gradslc
