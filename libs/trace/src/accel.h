// SPDX-License-Identifier: MIT
// The Embree scene made from a scene's instances. Geometry ids of its top level are indices into
// Scene::instances.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "alpha_filter.h"
#include "embree_api.h"
#include "relume/core/vec.h"
#include "relume/trace/tracer.h"

namespace relume::trace {

/// How a hit on an instance is judged.
struct InstanceTraits {
  bool present = false;
  bool referenced = false;      ///< an Embree instance: Embree gives normals in mesh space
  bool mirrored = false;        ///< world winding is the reverse of mesh winding (copied instances only)
  bool double_sided = false;    ///< never seen from behind
  Mat3 local_from_world{1.0f};  ///< of directions; referenced instances only
};

class Accel {
 public:
  Accel(const scene::Scene& scene, const TracerOptions& options);
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;
  ~Accel();

  RTCScene root() const { return root_.get(); }
  const scene::Scene& scene() const { return scene_; }
  const std::vector<InstanceTraits>& traits() const { return traits_; }
  /// Whether any instance is mirrored, referenced or double-sided, i.e. a lane's normal alone does not tell
  /// its side.
  bool needsTraits() const { return needs_traits_; }
  std::uint64_t bytes() const { return static_cast<std::uint64_t>(embree_bytes_.load()) + vertex_bytes_; }

 private:
  template <class T, void (*Release)(T)>
  struct Releaser {
    void operator()(T handle) const { Release(handle); }
  };
  template <class T, void (*Release)(T)>
  using Handle = std::unique_ptr<std::remove_pointer_t<T>, Releaser<T, Release>>;
  using SceneHandle = Handle<RTCScene, rtcReleaseScene>;
  using GeometryHandle = Handle<RTCGeometry, rtcReleaseGeometry>;

  void build();
  GeometryHandle triangles(const scene::Mesh& mesh, const Mat4* world_from_local);
  SceneHandle newScene() const;
  void commit(RTCScene scene) const;
  void throwOnError() const;
  static bool countMemory(void* accel, ssize_t bytes, bool post);

  const scene::Scene& scene_;
  std::atomic<std::int64_t> embree_bytes_{0};  // before the device, which reports to it until it is released
  std::uint64_t vertex_bytes_ = 0;
  bool include_dynamic_ = false, needs_traits_ = false;
  Passing passing_;
  std::vector<InstanceTraits> traits_;
  std::vector<std::vector<Point>> vertices_;  // world space, of copied instances
  Handle<RTCDevice, rtcReleaseDevice> device_;
  std::vector<SceneHandle> mesh_scenes_;
  SceneHandle root_;
};

}  // namespace relume::trace
