// SPDX-License-Identifier: MIT
// Entries as bakes place them: where their light is taken, and what it is on pieces of surface.
#pragma once
#include <vector>

#include "light_paths/clusters.h"
#include "light_paths/light_view.h"
#include "light_paths/light_walks.h"
#include "light_paths/piece_entries.h"
#include "light_paths/pieces.h"
#include "light_paths/places.h"
#include "light_paths/shot_entries.h"
#include "lightmap/reflectance.h"
#include "relume/transport/light_paths.h"

namespace relume::transport {

struct EntrySet {
  Entries entries;
  std::vector<Place> places;  ///< of their samples
  PieceEntries on_pieces;
  std::vector<WalkStart> starts;  ///< of random walks, if asked for
  float spacing = 0;              ///< metres: side of a square of an entry's area, where lights shine
};

/// What pieces of surface are known by. References are kept by nobody.
struct PieceScene {
  const SurfaceScene& surface;
  const Sides& sides;
  const Pieces& pieces;
  const MeanReflectance& reflectance;
};

/// Groups of pieces, each of which has as many entries as its light needs (patch_modes.h).
/// boxes: where training lamps may stand. Throws Error kInterrupted.
EntrySet patchEntries(const PieceScene& scene, const LightView& light, std::span<const Box3> boxes,
                      const LightPathOptions& options, Progress& progress);

/// Points, shot from the places where lights may be. Throws Error kEmptyScene where there are none, or where
/// they see no surface; kInterrupted.
EntrySet shotEntries(const PieceScene& scene, std::span<const Box3> boxes, const LightPathOptions& options,
                     Progress& progress);

}  // namespace relume::transport
