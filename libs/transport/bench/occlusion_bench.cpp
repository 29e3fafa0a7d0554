// SPDX-License-Identifier: MIT
// Rates of the occlusion solver, everything included (sequences, sorting, tracing, error estimate), beside
// bare Embree in the same process: one rtcOccluded1 or rtcIntersect1 after the other on the very rays of the
// same texels, unsorted, prepared beforehand, with Embree's default flags. One thread. Counter
// `rays_per_second` is the one to compare, `ratio` does it.
#include <benchmark/benchmark.h>
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <ctime>
#include <map>
#include <string>

#include "../tests/made_scenes.h"
#include "relume/core/frame.h"
#include "relume/core/parallel.h"
#include "relume/core/progress.h"
#include "relume/core/sampling.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

using Shape = DistanceWeight::Shape;

constexpr std::uint32_t kSamples = 256;

/// 64 x 64 texels of 5 cm on the floor, under the columns or between the boxes.
struct Setting {
  scene::Scene scene;
  atlas::Texels texels;
};

Setting settingOf(const std::string& name) {
  if (name == "room")
    return {made::room(), made::texelGrid(64, 64, {-1.95f, -1.95f, 0}, {0.06f, 0, 0}, {0, 0.06f, 0})};
  return {made::temple(100000), made::texelGrid(64, 64, {-1.7f, -1.7f, 0}, {0.05f, 0, 0}, {0, 0.05f, 0})};
}

/// A scene in Embree as its tutorials make one, with its rays.
class Bare {
 public:
  Bare(const Setting& setting, float limit) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
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
      for (std::uint32_t i = 0; i < kSamples; ++i) {
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

/// Rate of the bare variant of a case, for the ratio of the other.
std::map<std::string, double>& bareRates() {
  static std::map<std::string, double> rates;
  return rates;
}

double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void bare(benchmark::State& state, const std::string& where, bool any_hit, float limit) {
  const Bare scene(settingOf(where), limit);
  const double start = cpuSeconds();
  double rays = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(any_hit ? scene.occluded() : scene.intersect());
    rays += static_cast<double>(scene.rays());
  }
  bareRates()[where + (any_hit ? "a" : "f") + std::to_string(limit)] = rays / (cpuSeconds() - start);
  state.counters["rays_per_second"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}

void solver(benchmark::State& state, const std::string& where, bool any_hit, float limit,
            std::uint32_t samples) {
  const ThreadLimit one(1);
  const Setting setting = settingOf(where);
  const trace::Tracer tracer(setting.scene);
  OcclusionOptions options;
  options.weight = {any_hit ? Shape::kStep : Shape::kExponential, 1.0f, limit};
  options.min_samples = options.max_samples = samples;
  SilentProgress silent;
  const double start = cpuSeconds();
  double rays = 0;
  for (auto _ : state) {
    rays += static_cast<double>(solveOcclusion(tracer, setting.texels, options, silent).rays);
  }
  const double rate = rays / (cpuSeconds() - start);
  state.counters["rays_per_second"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
  const auto found = bareRates().find(where + (any_hit ? "a" : "f") + std::to_string(limit));
  if (found != bareRates().end()) state.counters["ratio"] = rate / found->second;
}

void limits(benchmark::State& state) {  // cost must fall with the distance limit
  const ThreadLimit one(1);
  const Setting setting = settingOf("temple");
  const trace::Tracer tracer(setting.scene);
  OcclusionOptions options;
  options.weight.limit = static_cast<float>(state.range(0)) / 100.0f;
  SilentProgress silent;
  double rays = 0;
  for (auto _ : state) {
    rays += static_cast<double>(solveOcclusion(tracer, setting.texels, options, silent).rays);
  }
  state.counters["rays_per_second"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}

const bool kRegistered = [] {
  for (const std::string where : {"room", "temple"}) {
    for (const bool any_hit : {true, false}) {
      for (const float limit : {kInfinity, 2.0f}) {
        const std::string name =
            where + (any_hit ? ".occluded." : ".intersect.") + (limit < kInfinity ? "2m" : "endless");
        benchmark::RegisterBenchmark(("transport.bare." + name).c_str(),
                                     [=](benchmark::State& s) { bare(s, where, any_hit, limit); });
        for (const std::uint32_t samples : {16u, 64u, 256u}) {
          benchmark::RegisterBenchmark(
              ("transport.solver." + name + "." + std::to_string(samples)).c_str(),
              [=](benchmark::State& s) { solver(s, where, any_hit, limit, samples); });
        }
      }
    }
  }
  benchmark::RegisterBenchmark("transport.limit_cm", limits)
      ->Arg(25)
      ->Arg(50)
      ->Arg(100)
      ->Arg(200)
      ->Arg(400)
      ->Arg(1000);
  return true;
}();

}  // namespace
}  // namespace relume::transport
