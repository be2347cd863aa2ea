#include "scene/scene.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <immintrin.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "scene/focus.h"
#include "scene/triangle.h"

namespace gradslc {
namespace {

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct GeometryRelease {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Geometry = std::unique_ptr<RTCGeometryTy, GeometryRelease>;
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

// In the pieces that Embree reads: values that were written in smaller ones make the processor wait.
void to_embree(const Ray& ray, RTCRay& out) {
  // Distances start above 0: where a ray starts exactly on another surface's plane, as in corners, that is no hit.
  const float near = std::numeric_limits<float>::min(), time = 0;
  static_assert(offsetof(RTCRay, tnear) == 12 && offsetof(RTCRay, dir_x) == 16 && offsetof(RTCRay, time) == 28);
  _mm_store_ps(&out.org_x, _mm_setr_ps(ray.origin.x, ray.origin.y, ray.origin.z, near));
  _mm_store_ps(&out.dir_x, _mm_setr_ps(ray.direction.x, ray.direction.y, ray.direction.z, time));
  out.tfar = ray.max_distance;
  out.mask = 0xffffffffu;
  out.id = out.flags = 0;
}

Vec2 interpolate_uv(const PreparedTriangle& triangle, float b1, float b2) {
  const auto& [a, b, c] = triangle.uvs;
  return (1 - b1 - b2) * a + b1 * b + b2 * c;
}

/// dp/du and dp/dv of a triangle, zero where the uvs are degenerate.
MaterialPoint with_derivatives(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t, Vec2 uv) {
  const Vec3 ab = mesh.positions[t[1]] - mesh.positions[t[0]], ac = mesh.positions[t[2]] - mesh.positions[t[0]];
  if (mesh.uvs.empty()) return {uv, ab, ac};
  const Vec2 uv_ab = mesh.uvs[t[1]] - mesh.uvs[t[0]], uv_ac = mesh.uvs[t[2]] - mesh.uvs[t[0]];
  const float determinant = uv_ab.x * uv_ac.y - uv_ab.y * uv_ac.x;
  if (determinant == 0) return {uv, Vec3(), Vec3()};
  return {uv, (uv_ac.y * ab - uv_ab.y * ac) / determinant, (uv_ab.x * ac - uv_ac.x * ab) / determinant};
}

/// The interpolated normal; the geometric one where there is none.
Normal3 interpolate_normal(const PreparedTriangle& triangle, float b1, float b2) {
  const auto& [a, b, c] = triangle.normals;
  const Vec3 sum = (1 - b1 - b2) * as_vec(a) + b1 * as_vec(b) + b2 * as_vec(c);
  const float squared = length_squared(sum);
  if (!(squared > 0)) return triangle.shape.normal;
  return as_normal(sum / std::sqrt(squared));
}

/// Whether anything blocks a ray. It may look past surfaces that can let light pass straight through, and notes that it
/// did.
struct ShadowQuery {
  RTCIntersectContext context;  // first: Embree hands its address on
  bool skips_crossings;
  bool skipped = false;

  explicit ShadowQuery(bool skip_crossings) : skips_crossings(skip_crossings) { rtcInitIntersectContext(&context); }

  bool finds_blocker(RTCScene scene, const Ray& ray) {
    RTCRay shadow;
    to_embree(ray, shadow);
    rtcOccluded1(scene, &context, &shadow);
    return shadow.tfar < 0;
  }

  /// Embree's filter of surfaces that can let light pass.
  static void skip(const RTCFilterFunctionNArguments* arguments) {
    auto* query = reinterpret_cast<ShadowQuery*>(arguments->context);
    if (!query->skips_crossings) return;
    query->skipped = true;
    arguments->valid[0] = 0;
  }
};
static_assert(std::is_standard_layout_v<ShadowQuery>);

/// The same for up to 16 rays side by side.
struct ShadowPacketQuery {
  static constexpr std::size_t k_size = 16;
  RTCIntersectContext context;        // first, as above
  std::uint32_t skips_crossings = 0;  // bits, as in the next two
  std::uint32_t skipped = 0, blocked = 0;

  void trace(RTCScene scene, std::span<const Ray> rays) {
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) std::array<int, k_size> valid = {};
    RTCRay16 packet;
    for (std::size_t i = 0; i < k_size; ++i) packet.tfar[i] = -1;  // not traced
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i];
      valid[i] = -1;
      packet.org_x[i] = ray.origin.x, packet.org_y[i] = ray.origin.y, packet.org_z[i] = ray.origin.z;
      packet.dir_x[i] = ray.direction.x, packet.dir_y[i] = ray.direction.y, packet.dir_z[i] = ray.direction.z;
      packet.tnear[i] = std::numeric_limits<float>::min(), packet.tfar[i] = ray.max_distance;
      packet.time[i] = 0, packet.mask[i] = 0xffffffffu, packet.flags[i] = 0;
      packet.id[i] = static_cast<unsigned>(i);
    }
    rtcOccluded16(valid.data(), scene, &context, &packet);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (packet.tfar[i] < 0) blocked |= 1u << i;
  }

  static void skip(const RTCFilterFunctionNArguments* arguments) {
    auto* query = reinterpret_cast<ShadowPacketQuery*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
      if (arguments->valid[i] == 0) continue;
      const std::uint32_t bit = 1u << RTCRayN_id(arguments->ray, arguments->N, i);
      if ((query->skips_crossings & bit) == 0) continue;
      query->skipped |= bit;
      arguments->valid[i] = 0;
    }
  }
};
static_assert(std::is_standard_layout_v<ShadowPacketQuery>);

/// Embree's filter of surfaces that can let light pass: which query asks is known by its flags.
void skip_crossings(const RTCFilterFunctionNArguments* arguments) {
  if (arguments->context->flags == RTC_INTERSECT_CONTEXT_FLAG_COHERENT)
    ShadowPacketQuery::skip(arguments);
  else
    ShadowQuery::skip(arguments);
}

}  // namespace

/// Device, scene and what they use of memory.
struct Scene::Embree {
  std::atomic<std::ptrdiff_t> bytes = 0;
  std::unique_ptr<RTCDeviceTy, DeviceRelease> device;
  std::unique_ptr<RTCSceneTy, SceneRelease> scene;

  /// `crosses`: per material.
  Embree(const std::vector<TriangleMesh>& meshes, const std::vector<bool>& crosses);
  Geometry make_geometry(const TriangleMesh& mesh, bool crosses) const;
  void check() const;
};

Scene::Embree::Embree(const std::vector<TriangleMesh>& meshes, const std::vector<bool>& crosses)
    : device(rtcNewDevice(nullptr)) {
  if (!device)
    throw_failure("", fmt::format("Embree cannot be started (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
  const auto count_bytes = [](void* user, ssize_t change, bool) {
    static_cast<Embree*>(user)->bytes += change;
    return true;
  };
  rtcSetDeviceMemoryMonitorFunction(device.get(), count_bytes, this);
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  std::vector<Geometry> geometries(meshes.size());
  parallel_for(meshes.size(), 1, [&](std::size_t i, std::size_t) {
    if (!meshes[i].triangles.empty()) geometries[i] = make_geometry(meshes[i], crosses[meshes[i].material]);
  });
  for (std::size_t i = 0; i < geometries.size(); ++i)
    if (geometries[i]) rtcAttachGeometryByID(scene.get(), geometries[i].get(), static_cast<unsigned int>(i));
  rtcCommitScene(scene.get());
  check();
}

Geometry Scene::Embree::make_geometry(const TriangleMesh& mesh, bool crosses) const {
  Geometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  // Copies: Embree reads 16 bytes for each vertex of 12, beyond the end of a shared buffer.
  void* positions = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                            sizeof(Point3), mesh.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          sizeof(mesh.triangles[0]), mesh.triangles.size());
  check();  // here: Embree keeps errors by thread
  std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<Point3*>(positions));
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), static_cast<std::array<std::uint32_t, 3>*>(indices));
  if (crosses) rtcSetGeometryOccludedFilterFunction(geometry.get(), skip_crossings);
  rtcCommitGeometry(geometry.get());
  check();
  return geometry;
}

void Scene::Embree::check() const {
  const RTCError error = rtcGetDeviceError(device.get());
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw_failure("", "not enough memory for the acceleration structure");
  if (error != RTC_ERROR_NONE)
    throw_failure("",
                  fmt::format("Embree cannot build the acceleration structure (error {})", static_cast<int>(error)));
}

Scene::Scene(SceneDescription description) : description_(std::move(description)) {
  for (const TriangleMesh& mesh : description_.meshes) {
    if (mesh.material >= description_.materials.size())
      throw_input_error("", fmt::format("mesh \"{}\": has material {}, there are {}", mesh.name, mesh.material,
                                        description_.materials.size()));
    if (mesh.area_light >= static_cast<std::int64_t>(description_.area_lights.size()))
      throw_input_error("", fmt::format("mesh \"{}\": has area light {}, there are {}", mesh.name, mesh.area_light,
                                        description_.area_lights.size()));
  }
  PreparedMeshes prepared = prepare_meshes(description_.meshes);
  prepared_ = std::move(prepared.meshes);
  bounds_ = prepared.bounds;
  for (const MaterialPtr& material : description_.materials) {
    needs_derivatives_.push_back(material->needs_derivatives());
    crosses_.push_back(material->crosses());
  }
  for (const TriangleMesh& mesh : description_.meshes) has_crossings_ |= crosses_[mesh.material];
  embree_ = std::make_unique<Embree>(description_.meshes, crosses_);
  emitters_ = Emitters(description_.meshes, description_.area_lights, description_.lights,
                       {.scene = bounding_sphere(), .focus = find_focus(*this)});
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::optional<SurfacePoint> Scene::intersect(const Ray& ray) const {
  RTCRayHit hit;
  to_embree(ray, hit.ray);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(embree_->scene.get(), &context, &hit);
  std::optional<SurfacePoint> point;
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return point;

  const PreparedMesh& mesh = prepared_[hit.hit.geomID];
  const PreparedTriangle& triangle = mesh.triangles[hit.hit.primID];
  const float b1 = hit.hit.u, b2 = hit.hit.v;
  point.emplace();
  point->position = triangle_position(triangle, b1, b2);
  point->error = triangle.shape.error;
  point->shading_normal = point->geometric_normal = triangle.shape.normal;
  point->uv = {b1, b2};
  if (mesh.has_uvs) point->uv = interpolate_uv(triangle, b1, b2);
  if (mesh.has_normals) {
    point->shading_normal = interpolate_normal(triangle, b1, b2);
    point->geometric_normal = face_forward(triangle.shape.normal, as_vec(point->shading_normal));
  }
  point->mesh = hit.hit.geomID;
  point->triangle = hit.hit.primID;
  point->material = mesh.material;
  return point;
}

void Scene::shade(const SurfacePoint& point, const Vec3& wo, ShadedPoint& shaded) const {
  shaded.point = point;
  MaterialPoint at{point.uv, Vec3(), Vec3()};
  if (needs_derivatives_[point.material]) {
    const TriangleMesh& mesh = description_.meshes[point.mesh];
    at = with_derivatives(mesh, mesh.triangles[point.triangle], point.uv);
    shaded.frame = frame_from_normal_and_tangent(point.shading_normal, at.dp_du);
  } else {
    shaded.frame = frame_from_normal(point.shading_normal);
  }
  description_.materials[point.material]->shade(at, wo, shaded);
  shaded.wo = shaded.frame.to_local(wo);
}

bool Scene::occluded(const Ray& ray) const { return ShadowQuery(false).finds_blocker(embree_->scene.get(), ray); }

Passage Scene::passage(const Ray& ray, int max_crossings) const {
  ShadowQuery query(max_crossings > 0);
  if (query.finds_blocker(embree_->scene.get(), ray)) return {.transmittance = Rgb()};
  return query.skipped ? walk(ray, max_crossings) : Passage();
}

void Scene::passages(std::span<const Ray> rays, std::span<const int> max_crossings, std::span<Passage> passages) const {
  for (std::size_t begin = 0; begin < rays.size(); begin += ShadowPacketQuery::k_size) {
    const std::size_t count = std::min(ShadowPacketQuery::k_size, rays.size() - begin);
    ShadowPacketQuery query;
    for (std::size_t i = 0; i < count; ++i)
      if (max_crossings[begin + i] > 0) query.skips_crossings |= 1u << i;
    query.trace(embree_->scene.get(), rays.subspan(begin, count));
    for (std::size_t i = 0; i < count; ++i) {
      Passage& passage = passages[begin + i] = Passage();
      const std::uint32_t bit = 1u << i;
      if ((query.blocked & bit) != 0)
        passage.transmittance = Rgb();
      else if ((query.skipped & bit) != 0)
        passage = walk(rays[begin + i], max_crossings[begin + i]);
    }
  }
}

Passage Scene::walk(const Ray& ray, int max_crossings) const {
  Passage passage;
  const Vec3 back = -normalize(ray.direction);
  Ray rest = ray;
  while (true) {
    ++passage.rays;
    const auto hit = intersect(rest);
    if (!hit) return passage;
    float probability = 0;
    if (crosses_[hit->material] && passage.crossings < max_crossings) {
      const ShadedPoint point = shade(*hit, back);
      probability = point.bsdf.pass_probability(point.wo);
      passage.transmittance *= point.bsdf.straight_transmittance();
    }
    if (probability == 0) {
      passage.transmittance = Rgb();
      return passage;
    }
    passage.probability *= probability;
    ++passage.crossings;
    rest = pass_on(rest, *hit);
  }
}

BoundingSphere Scene::bounding_sphere() const {
  if (bounds_.empty()) return {Point3(), 1};  // any size: so environments have power
  return {bounds_.centre(), 0.5f * length(bounds_.diagonal())};
}

std::size_t Scene::triangle_count() const {
  std::size_t count = 0;
  for (const TriangleMesh& mesh : description_.meshes) count += mesh.triangles.size();
  return count;
}

std::size_t Scene::memory_bytes() const {
  std::size_t bytes = static_cast<std::size_t>(embree_->bytes.load());
  for (const TriangleMesh& mesh : description_.meshes)
    bytes += mesh.positions.size() * sizeof(Point3) + mesh.normals.size() * sizeof(Normal3) +
             mesh.uvs.size() * sizeof(Vec2) + mesh.triangles.size() * sizeof(mesh.triangles[0]);
  for (const PreparedMesh& mesh : prepared_) bytes += mesh.triangles.size() * sizeof(PreparedTriangle);
  return bytes;
}

}  // namespace gradslc
