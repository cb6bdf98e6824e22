// SPDX-License-Identifier: Apache-2.0
#include <limits>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <burnish/error.h>
#include <burnish/render/ray_caster.h>

namespace burnish {

namespace {

RTCRay ray_of(Vec3 origin, Vec3 direction, double near, double far) noexcept {
  RTCRay ray{};
  const auto o = to_floats(origin), d = to_floats(direction);
  ray.org_x = o[0];
  ray.org_y = o[1];
  ray.org_z = o[2];
  ray.dir_x = d[0];
  ray.dir_y = d[1];
  ray.dir_z = d[2];
  ray.tnear = static_cast<float>(near);
  ray.tfar = static_cast<float>(far);
  ray.mask = ~0u;
  return ray;
}

// Embree 4 has no context in these calls.
void intersect(RTCScene scene, RTCRayHit* ray) noexcept {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, ray);
#endif
}
void occlude(RTCScene scene, RTCRay* ray) noexcept {
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene, ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, ray);
#endif
}

}  // namespace

struct RayCaster::State {
  std::span<const MeshPart> parts;
  // one thread builds the tree, so that it is always the same
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = nullptr;
};

RayCaster::RayCaster(std::span<const MeshPart> parts) : state_(std::make_unique<State>()) {
  if (!state_->device) throw Error("ray casting: expected Embree to start, found that it does not");
  state_->parts = parts;
  state_->scene = rtcNewScene(state_->device);
  rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
  for (const auto& [mesh, material] : parts) {
    RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* places = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
    for (const Vertex& vertex : mesh.vertices)
      for (const float x : vertex.position) *places++ = x;
    auto* corners = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t corner : triangle) *corners++ = corner;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(state_->scene, geometry);  // numbered from 0 in order
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(state_->scene);
}

RayCaster::~RayCaster() {
  rtcReleaseScene(state_->scene);
  rtcReleaseDevice(state_->device);
}

std::optional<SurfaceHit> RayCaster::nearest(Vec3 origin, Vec3 direction) const noexcept {
  RTCRayHit ray{};
  ray.ray = ray_of(origin, direction, 0, std::numeric_limits<double>::infinity());
  ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersect(state_->scene, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  SurfaceHit hit{.part = ray.hit.geomID, .triangle = ray.hit.primID};
  // the weights once more in double precision
  const Mesh& mesh = state_->parts[hit.part].mesh;
  const auto& corners = mesh.triangles[hit.triangle];
  const auto at = [&](std::size_t k) { return to_vec3(mesh.vertices[corners[k]].position); };
  const Vec3 a = at(1) - at(0), b = at(2) - at(0), from = origin - at(0);
  const Vec3 p = cross(direction, b);
  const double determinant = dot(a, p);
  if (determinant == 0) return {};
  hit.u = dot(from, p) / determinant;
  hit.v = dot(direction, cross(from, a)) / determinant;
  return hit;
}

bool RayCaster::blocked(Vec3 from, Vec3 to) const noexcept {
  RTCRay ray = ray_of(from, to - from, 1e-4, 1 - 1e-4);
  occlude(state_->scene, &ray);
  return ray.tfar < 0;
}

}  // namespace burnish
