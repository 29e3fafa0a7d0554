// SPDX-License-Identifier: MIT
// Small pieces of surface, of which entries and elements are made: blocks of texels of one chart, fronts and
// backs apart.
#pragma once
#include <cstdint>
#include <vector>

#include "light_paths/sides.h"

namespace relume::transport {

struct Piece {
  Point position{0};  ///< on the surface, in the middle
  Normal normal{0, 0, 1};
  float area = 0;  ///< m^2
};

struct Pieces {
  std::vector<Piece> all;
  std::vector<std::uint32_t> of_side;  ///< scene::kNone for buried sides
  std::size_t size() const { return all.size(); }
  double area() const;
};

/// As small as they may be so that there are at most `most`, where charts are not more already.
Pieces makePieces(const atlas::Texels& texels, const Sides& sides, std::size_t most);

}  // namespace relume::transport
