// SPDX-License-Identifier: MIT
// Rays against the static part of a scene. The only part that knows Embree.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "relume/core/vec.h"
#include "relume/scene/scene.h"

namespace relume::trace {

struct Ray {
  Point origin;
  Direction direction;
  float t_max = kInfinity;  ///< metres
};

struct RayHit {
  scene::Hit where;        ///< where.instance == scene::kNone: nothing was hit
  float t = kInfinity;     ///< metres
  bool back_face = false;  ///< hit from behind (by winding); a double-sided material never counts as back
  explicit operator bool() const { return where.instance != scene::kNone; }
};

/// The point from which a ray that leaves a surface at p starts: moved off along the geometric normal by a
/// few float spacings of the coordinates (Waechter, Binder, Ray Tracing Gems ch. 6), so it does not hit the
/// surface it leaves.
Point offsetOrigin(Point p, Normal geometric_normal);

/// Up to 16 rays in lanes, one array per field: what packets are traced from. Rays that start close together
/// and are sorted by direction run several times faster than single rays; unsorted ones should not come in
/// packets at all.
struct alignas(64) RayPacket {
  static constexpr std::size_t kSize = 16;
  float origin_x[kSize], origin_y[kSize], origin_z[kSize];           ///< metres
  float direction_x[kSize], direction_y[kSize], direction_z[kSize];  ///< unit
  float t_max[kSize];  ///< metres; a negative one skips the lane
  std::uint32_t alpha_seed[kSize];
};

/// First hits of a packet. A lane is meaningful where its bit of `hit` is set, but t, which is t_max where
/// nothing was hit.
struct alignas(64) HitPacket {
  float t[RayPacket::kSize];  ///< metres
  float b1[RayPacket::kSize], b2[RayPacket::kSize];
  std::uint32_t instance[RayPacket::kSize], triangle[RayPacket::kSize];
  std::uint32_t hit = 0, back_face = 0;  ///< bit i: lane i
  /// The surface was met on the side its normal points away from, whatever its material says of sides.
  std::uint32_t behind = 0;
  scene::Hit where(std::size_t lane) const { return {instance[lane], triangle[lane], b1[lane], b2[lane]}; }
};

/// How the rays of a packet lie, which decides how their first hits are found: those of a slim bundle
/// together, those of a wide one, which meet many triangles, one by one. The hits may differ in their last
/// bits, so nothing that varies between runs may decide.
enum class Bundle : std::uint8_t { kSlim, kWide };

struct TracerOptions {
  std::string
      isa;  ///< "", "sse2", "avx", "avx2", "avx512": which kernels Embree uses (bits may differ between them)
  bool include_dynamic = false;  ///< also dynamic instances (pictures)
  /// Rays meet surfaces of KHR_materials_transmission like any other, instead of passing them by chance: for
  /// those who know what passes (its colour, what is mirrored).
  bool stop_at_transmission = false;
};

class Tracer {
 public:
  /// Keeps a reference to `scene`, which must outlive it and not change. Throws Error kUsage for an ISA that
  /// is not known or not there, kOutOfMemory. Hits do not depend on the number of threads, neither of
  /// building nor of tracing.
  explicit Tracer(const scene::Scene& scene, const TracerOptions& options = {});
  ~Tracer();
  Tracer(Tracer&&) noexcept;

  const scene::Scene& scene() const;

  /// First hit. Alpha: MASK as the cut-off says; BLEND stochastically, by a hash of (seed of the ray,
  /// triangle), so that the mean over seeds is the opacity. Transmission lets its share of the rays through,
  /// straight on, unless they stop at it.
  RayHit intersect(const Ray& ray, std::uint32_t alpha_seed = 0) const;
  /// Whether anything lies on the ray.
  bool occluded(const Ray& ray, std::uint32_t alpha_seed = 0) const;

  /// Packets of up to 16 rays that start close together and are sorted by direction: several times the rate
  /// of single rays. Rays with t_max < 0 are skipped. spans: equal length, at most kPacket.
  static constexpr std::size_t kPacket = RayPacket::kSize;
  void intersectPacket(std::span<const Ray> rays, std::span<const std::uint32_t> alpha_seeds,
                       std::span<RayHit> hits) const;
  void occludedPacket(std::span<const Ray> rays, std::span<const std::uint32_t> alpha_seeds,
                      std::span<bool> occluded) const;

  /// The same without a detour through Ray and RayHit.
  void intersectPacket(const RayPacket& rays, HitPacket& hits, Bundle bundle = Bundle::kSlim) const;
  /// Bit i: something lies on the ray of lane i.
  std::uint32_t occludedPacket(const RayPacket& rays) const;

  std::uint64_t bytes()
      const;  ///< of the acceleration structure, as Embree counts, and of the tracer's own vertices

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relume::trace
