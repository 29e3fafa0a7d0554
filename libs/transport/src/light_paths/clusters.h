// SPDX-License-Identifier: MIT
// Pieces of surface, or other places with an area, in groups that are compact and face one way: Lloyd's
// method on position and normal.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

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

/// About `count` clusters of about equal area, none without a piece. A normal that turns by an angle a counts
/// as 2 sin(a / 2) `normal_weight` clusters' sides. `seed` moves where Lloyd's method begins.
Clusters makeClusters(std::span<const Piece> pieces, std::size_t count, float normal_weight,
                      std::uint64_t seed, Progress& progress);

/// Parts clusters where a wall stands between their pieces: a piece goes to the nearest cluster whose middle
/// it sees from just above the surface, or to a new one.
void partAtWalls(const trace::Tracer& tracer, std::span<const Piece> pieces, Clusters& clusters,
                 Progress& progress);

}  // namespace relume::transport
