// SPDX-License-Identifier: MIT
// Bare Embree as its tutorials use it: one ray after the other, with its default flags, on rays prepared
// beforehand.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <ctime>
#include <vector>

#include "../tests/made_scenes.h"
#include "relume/core/frame.h"
#include "relume/core/sampling.h"
#include "relume/trace/tracer.h"

namespace relume::transport::bench {

/// A scene with texels to send rays from.
struct Setting {
  scene::Scene scene;
  atlas::Texels texels;
};

/// A scene in Embree as its tutorials make one, with its rays.
class Bare {
 public:
  /// `samples` cosine-weighted rays from all over each texel, in the texels' order.
  Bare(const Setting& setting, float limit, std::uint32_t samples)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    for (const scene::Instance& instance : setting.scene.instances) {
      const scene::Mesh& mesh = setting.scene.meshes[instance.mesh];
      RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* vertices = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
          geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.positions.size()));
      for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        vertices[i] = Vec3(instance.world_from_local * Vec4(mesh.positions[i], 1.0f));
      }
      void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              sizeof(UVec3), mesh.triangles.size());
      std::copy(mesh.triangles.begin(), mesh.triangles.end(), static_cast<UVec3*>(indices));
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_, geometry);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_);
    for (const atlas::SurfacePoint& point : setting.texels.points) {
      const Frame frame = Frame::about(point.shading_normal);
      for (std::uint32_t i = 0; i < samples; ++i) {
        const Direction d = frame.toWorld(squareToCosineHemisphere(sobol2(i, streamOf(1, point.texel, 0))));
        const Vec2 u = sobol2(i, streamOf(1, point.texel, 1)) - 0.5f;
        const Point p = trace::offsetOrigin(point.position + u.x * point.dp_dx + u.y * point.dp_dy,
                                            point.geometric_normal);
        rays_.push_back({p, d, limit});
      }
    }
  }
  Bare(const Bare&) = delete;
  ~Bare() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  std::size_t occluded() const {
    std::size_t blocked = 0;
    for (const trace::Ray& ray : rays_) {
      RTCRay r = rayOf(ray);
#if RTC_VERSION_MAJOR >= 4
      rtcOccluded1(scene_, &r, nullptr);
#else
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcOccluded1(scene_, &context, &r);
#endif
      blocked += r.tfar < 0.0f;
    }
    return blocked;
  }
  std::size_t intersect() const {
    std::size_t hits = 0;
    for (const trace::Ray& ray : rays_) {
      RTCRayHit r;
      r.ray = rayOf(ray);
      r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
      rtcIntersect1(scene_, &r, nullptr);
#else
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcIntersect1(scene_, &context, &r);
#endif
      hits += r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
  }
  std::size_t rays() const { return rays_.size(); }

 private:
  static RTCRay rayOf(const trace::Ray& ray) {
    RTCRay r;
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
    r.tnear = 0, r.tfar = ray.t_max, r.time = 0, r.mask = ~0u, r.id = 0, r.flags = 0;
    return r;
  }

  RTCDevice device_;
  RTCScene scene_;
  std::vector<trace::Ray> rays_;
};

inline double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace relume::transport::bench
