// SPDX-License-Identifier: MIT
#include "light_paths/pieces.h"

#include <algorithm>
#include <cmath>

#include "radiosity/patches.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kLargestSide = 64;  // texels

}  // namespace

double Pieces::area() const {
  double sum = 0;
  for (const Piece& p : all) sum += static_cast<double>(p.area);
  return sum;
}

Pieces makePieces(const atlas::Texels& texels, const Sides& sides, std::size_t most) {
  const double share =
      static_cast<double>(sides.size()) / static_cast<double>(std::max<std::size_t>(most, 1));
  auto block = static_cast<std::uint32_t>(std::max(1.0, std::floor(std::sqrt(share))));
  Pieces pieces;
  Patches patches;
  for (; block <= kLargestSide; ++block) {
    patches = makePatches(texels, block, sides.buriedPoints());
    const double backs = static_cast<double>(sides.size()) / static_cast<double>(sides.points());
    if (static_cast<double>(patches.size()) * backs <= static_cast<double>(most)) break;
  }
  pieces.of_side.assign(sides.size(), scene::kNone);
  std::vector<std::uint32_t> front(patches.size(), scene::kNone), back(patches.size(), scene::kNone);
  for (std::size_t side = 0; side < sides.size(); ++side) {
    if (sides.buried(side)) continue;
    const std::uint32_t patch = patches.patch_of[sides.point(side)];
    std::uint32_t& piece = (sides.isBack(side) ? back : front)[patch];
    if (piece == scene::kNone) {
      piece = static_cast<std::uint32_t>(pieces.size());
      const Patch& p = patches.all[patch];
      pieces.all.push_back({p.centre, sides.isBack(side) ? -p.normal : p.normal, 0.0f});
    }
    pieces.of_side[side] = piece;
    pieces.all[piece].area += sides.area(side);
  }
  return pieces;
}

}  // namespace relume::transport
