// SPDX-License-Identifier: MIT
// Exits that are no blocks of texels: vertices of meshes, and probes in space.
#pragma once
#include <span>
#include <vector>

#include "light_paths/exit_rays.h"
#include "relume/transport/light_paths.h"

namespace relume::transport {

/// A corner of a triangle at a vertex.
struct Foot {
  std::uint32_t instance = 0, triangle = 0, corner = 0;
  float area = 0;  ///< m^2, of the triangle
};

struct PointExits {
  Exits exits;
  std::vector<std::uint32_t> first_foot;  ///< by vertex, and one more; empty: probes
  std::vector<Foot> feet;
};

/// One exit for each place and normal that vertices of static instances have in the world.
PointExits vertexExits(const scene::Scene& scene, const atlas::Atlas& atlas, const atlas::Texels& texels);

/// A grid over `box`, exits where rays all around do not end in bodies. Throws Error kUsage for more than a
/// million places, kEmptyScene where all are in bodies.
PointExits probeExits(const trace::Tracer& tracer, const Box3& box, float spacing);

/// What vertices and probes see, by single rays. One thread's.
class PointRays {
 public:
  PointRays(const ExitScene& scene, const PointExits& points);
  /// views: rows_each of them. The same bits every time. Rays of a vertex begin all over the nearest third of
  /// each of its triangles, cosine-weighted about its normal; those that end on the back of a single-sided
  /// face come from inside of something and do not count.
  void look(std::size_t exit, std::span<ExitView> views);

 private:
  struct Seen {
    std::uint32_t piece = scene::kNone;
    Vec3 reflectance{0};
    float direct = 1;
  };
  Seen seen(const trace::Ray& ray, std::uint32_t stream, bool& back) const;
  void lookFromVertex(std::size_t exit, ExitView& view);
  void lookFromProbe(std::size_t exit, std::span<ExitView> views);

  const ExitScene& scene_;
  const PointExits& points_;
  std::vector<WeightSum> direct_, reflected_;  // by row
};

}  // namespace relume::transport
