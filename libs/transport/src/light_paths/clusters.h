// SPDX-License-Identifier: MIT
// Pieces of surface, or other places with an area, in groups that are compact and face one way: Lloyd's
// method on position and normal.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light_paths/light_view.h"
#include "light_paths/nearest.h"
#include "light_paths/pieces.h"

namespace relume::transport {

struct Clusters {
  std::vector<std::uint32_t> of;  ///< by piece
  std::vector<Feature> centre;    ///< mean of the pieces
  float normal_length = 1;        ///< metres that a normal counts for in features
  std::size_t size() const { return centre.size(); }
  /// The feature of a place.
  Feature feature(Point position, Normal normal) const;
};

struct ClusterOptions {
  std::size_t count = 1;  ///< of clusters, about
  /// A normal that turns by an angle a counts as 2 sin(a / 2) times so many sides of a cluster.
  float normal_weight = 1.0f;
  std::uint64_t seed = 1;  ///< moves where Lloyd's method begins
};

/// Clusters of about equal sums of area times importance, none without a piece. importance: by piece, above
/// 0. core's kMeans compares each piece with all clusters, which takes too long for thousands.
Clusters makeClusters(std::span<const Piece> pieces, std::span<const float> importance,
                      const ClusterOptions& options, Progress& progress);

/// What becomes of parts too small to be clusters: they stay with those that they were parted from, if their
/// light is not wholly different; or, if no light comes to them, belong to none (scene::kNone).
enum class Slivers : std::uint8_t { kKept, kLeftOutIfDark };

/// Parts clusters whose pieces get light from different places, mostly because a wall stands between them: a
/// piece goes to the nearest cluster whose middle sees the same lights, or to a new one. Where lights do not
/// tell, pieces belong together that see each other from just above the surface.
void partByLight(const trace::Tracer& tracer, std::span<const Piece> pieces,
                 std::span<const float> importance, const LightView& light, Slivers slivers,
                 Clusters& clusters, Progress& progress);

/// Both, with about options.count clusters after they have been parted.
Clusters makeLitClusters(const trace::Tracer& tracer, std::span<const Piece> pieces,
                         std::span<const float> importance, const LightView& light,
                         const ClusterOptions& options, Slivers slivers, Progress& progress);

}  // namespace relume::transport
