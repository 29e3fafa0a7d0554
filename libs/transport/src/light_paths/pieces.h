// SPDX-License-Identifier: MIT
// Small pieces of surface, of which entries and elements are made: blocks of texels of one chart, fronts and
// backs apart.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light_paths/sides.h"

namespace relume::transport {

struct Piece {
  Point position{0};  ///< on the surface, in the middle
  Normal normal{0, 0, 1};
  float area = 0;  ///< m^2, of what other surfaces see of it: nothing where it lies upon something
};

struct Pieces {
  std::vector<Piece> all;
  std::vector<std::uint32_t> of_side;  ///< scene::kNone for buried sides
  std::uint32_t block = 1;             ///< texels along a side, of the largest
  std::size_t size() const { return all.size(); }
};

/// Blocks of 2^k texels along a side, one k for all: as small as they may be so that there are at most
/// `most`, where charts are not more already. Walls part them.
Pieces makePieces(const SurfaceScene& scene, const Sides& sides, std::size_t most);

/// The same for blocks of which each has its own k, so that area times importance is about equal. importance:
/// of coarse pieces; a block lies within one of them. As many as `most` or a few more.
Pieces refinedPieces(const SurfaceScene& scene, const Sides& sides, const Pieces& coarse,
                     std::span<const float> importance, std::size_t most);

}  // namespace relume::transport
