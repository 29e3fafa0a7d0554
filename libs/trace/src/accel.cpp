// SPDX-License-Identifier: MIT
// Builds the acceleration structure. An instance is copied to world space unless its mesh is used so often
// that copies would cost much memory: then it becomes an Embree instance, which costs rays about a third of
// their speed.
#include "accel.h"

#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "alpha_filter.h"
#include "relume/core/check.h"
#include "relume/core/error.h"

namespace relume::trace {
namespace {

// Triangles that copies of one mesh may add before it is referenced instead: some 80 MB of structure.
constexpr std::size_t kCopiedTriangles = std::size_t{1} << 20;

// Embree partitions triangles in as many pieces as its arena has slots, and the order in which a leaf holds
// them decides between hits at equal distance (coincident faces, shared edges). One slot makes the structure
// the same on every machine; it builds about a million triangles a second.
constexpr int kBuildSlots = 1;

std::string deviceConfig(const std::string& isa) {
  constexpr std::array<std::string_view, 5> kKnown = {"sse2", "sse4.2", "avx", "avx2", "avx512"};
  if (isa.empty()) return "";
  if (std::find(kKnown.begin(), kKnown.end(), isa) == kKnown.end()) {
    throw Error(ErrorCode::kUsage, fmt::format("instruction set \"{}\"", isa), "is not known",
                "use one of sse2, sse4.2, avx, avx2, avx512");
  }
  return "isa=" + isa;
}

bool isFiniteMatrix(const Mat4& m) {
  return isFinite(m[0]) && isFinite(m[1]) && isFinite(m[2]) && isFinite(m[3]);
}

}  // namespace

Accel::Accel(const scene::Scene& scene, const TracerOptions& options)
    : scene_(scene),
      include_dynamic_(options.include_dynamic),
      passing_(options.stop_at_transmission ? Passing::kAlpha : Passing::kAlphaAndTransmission) {
  device_.reset(rtcNewDevice(deviceConfig(options.isa).c_str()));
  if (!device_) {
    throw Error(ErrorCode::kUsage, fmt::format("instruction set \"{}\"", options.isa),
                "is not there on this machine or in this Embree", "leave it out or choose a smaller one");
  }
  rtcSetDeviceMemoryMonitorFunction(device_.get(), &Accel::countMemory, this);
  build();
}

Accel::~Accel() = default;

bool Accel::countMemory(void* accel, ssize_t bytes, bool) {
  static_cast<Accel*>(accel)->embree_bytes_ += bytes;
  return true;
}

Accel::SceneHandle Accel::newScene() const {
  SceneHandle scene(rtcNewScene(device_.get()));
  // Robust costs a tenth to a fifth of the speed and is watertight. Not compact, though it would halve the
  // memory (42 of 80 bytes per triangle): robust and compact together never return from rtcOccluded16 in
  // Embree 3.13.5's AVX-512 kernels.
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

void Accel::throwOnError() const {
  switch (const RTCError error = rtcGetDeviceError(device_.get())) {
    case RTC_ERROR_NONE:
      return;
    case RTC_ERROR_OUT_OF_MEMORY:
      throw Error(ErrorCode::kOutOfMemory, scene_.name, "memory ran out while the ray tracer was built",
                  "bake fewer objects at a time or on a machine with more memory");
    default:
      RELUME_CHECK_EQ(static_cast<int>(error), static_cast<int>(RTC_ERROR_NONE));
  }
}

void Accel::commit(RTCScene scene) const {
  tbb::task_arena(kBuildSlots).execute([&] { rtcCommitScene(scene); });
  throwOnError();
}

Accel::GeometryHandle Accel::triangles(const scene::Mesh& mesh, const Mat4* world_from_local) {
  GeometryHandle geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  const std::size_t count = mesh.positions.size();
  const Point* positions = mesh.positions.data();
  // Embree reads 16 bytes at each vertex, i.e. 4 beyond the last, so a vector without room to spare is copied
  // as well.
  if (world_from_local != nullptr || mesh.positions.capacity() == count) {
    std::vector<Point>& copy = vertices_.emplace_back();
    copy.reserve(count + 1);
    for (const Point& p : mesh.positions) {
      copy.push_back(world_from_local != nullptr ? Point(*world_from_local * Vec4(p, 1.0f)) : p);
    }
    vertex_bytes_ += copy.capacity() * sizeof(Point);
    positions = copy.data();
  }
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions, 0,
                             sizeof(Point), count);
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(UVec3), mesh.triangles.size());
  if (needsAlphaFilter(scene_, mesh, passing_)) {
    const auto filter = passing_ == Passing::kAlpha ? &alphaFilter<Passing::kAlpha>
                                                    : &alphaFilter<Passing::kAlphaAndTransmission>;
    rtcSetGeometryUserData(geometry.get(), const_cast<scene::Scene*>(&scene_));
    rtcSetGeometryIntersectFilterFunction(geometry.get(), filter);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), filter);
  }
  rtcCommitGeometry(geometry.get());
  return geometry;
}

void Accel::build() {
  traits_.resize(scene_.instances.size());
  mesh_scenes_.resize(scene_.meshes.size());
  root_ = newScene();
  std::vector<std::size_t> uses(scene_.meshes.size(), 0);
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    const scene::Instance& instance = scene_.instances[i];
    const scene::Mesh& mesh = scene_.meshes[instance.mesh];
    traits_[i].present = (include_dynamic_ || !instance.dynamic) && !mesh.triangles.empty();
    if (traits_[i].present) ++uses[instance.mesh];
  }
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    if (!traits_[i].present) continue;
    const scene::Instance& instance = scene_.instances[i];
    const scene::Mesh& mesh = scene_.meshes[instance.mesh];
    const Mat4& world_from_local = instance.world_from_local;
    const float determinant = glm::determinant(Mat3(world_from_local));
    const bool invertible = isFiniteMatrix(world_from_local) && std::isnormal(determinant);
    InstanceTraits& traits = traits_[i];
    traits.double_sided = scene_.materials[mesh.material].double_sided;
    traits.referenced = invertible && (uses[instance.mesh] - 1) * mesh.triangles.size() > kCopiedTriangles;
    traits.mirrored = !traits.referenced && determinant < 0.0f;
    needs_traits_ |= traits.referenced || traits.mirrored || traits.double_sided;

    GeometryHandle geometry;
    if (traits.referenced) {
      SceneHandle& mesh_scene = mesh_scenes_[instance.mesh];
      if (!mesh_scene) {
        mesh_scene = newScene();
        rtcAttachGeometryByID(mesh_scene.get(), triangles(mesh, nullptr).get(), 0);
        commit(mesh_scene.get());
      }
      traits.local_from_world = glm::inverse(Mat3(world_from_local));
      geometry.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
      rtcSetGeometryInstancedScene(geometry.get(), mesh_scene.get());
      rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &world_from_local);
      rtcCommitGeometry(geometry.get());
    } else {
      geometry = triangles(mesh, world_from_local == Mat4(1.0f) ? nullptr : &world_from_local);
    }
    rtcAttachGeometryByID(root_.get(), geometry.get(), static_cast<unsigned int>(i));
  }
  commit(root_.get());
}

}  // namespace relume::trace
