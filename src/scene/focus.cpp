#include "scene/focus.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "scene/scene.h"

namespace gradslc {
namespace {

std::vector<Point3> points_in_view(const Scene& scene) {
  constexpr int k_columns = 48, k_rows = 48;
  const Resolution resolution = scene.camera().resolution();
  std::vector<Point3> points;
  if (resolution.pixels() == 0) return points;
  for (int j = 0; j < k_rows; ++j)
    for (int i = 0; i < k_columns; ++i) {
      const Vec2 on_film{(static_cast<float>(i) + 0.5f) / k_columns * static_cast<float>(resolution.width),
                         (static_cast<float>(j) + 0.5f) / k_rows * static_cast<float>(resolution.height)};
      if (const auto hit = scene.intersect(scene.camera().generate_ray(on_film))) points.push_back(hit->position);
    }
  return points;
}

float quantile(std::vector<float>& values, double share) {
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

}  // namespace

BoundingSphere find_focus(const Scene& scene) {
  constexpr std::size_t k_fewest_points = 32;
  constexpr double k_share = 0.9;
  constexpr float k_margin = 1.5f, k_largest = 0.8f;  // of the scene's radius
  const std::vector<Point3> points = points_in_view(scene);
  if (points.size() < k_fewest_points) return {};
  std::vector<float> x, y, z, distances;
  for (const Point3& p : points) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
  const Point3 centre{quantile(x, 0.5), quantile(y, 0.5), quantile(z, 0.5)};
  for (const Point3& p : points) distances.push_back(length(p - centre));
  const float radius = k_margin * quantile(distances, k_share);
  if (!(radius < k_largest * scene.bounding_sphere().radius)) return {};
  return {centre, radius};
}

}  // namespace gradslc
