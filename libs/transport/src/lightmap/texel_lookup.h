// SPDX-License-Identifier: MIT
// From a hit to the texel that holds it.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "relume/atlas/atlas.h"
#include "relume/atlas/texels.h"

namespace relume::transport {

class TexelLookup {
 public:
  TexelLookup(const scene::Scene& scene, const atlas::Atlas& atlas, const atlas::Texels& texels);

  /// Index into Texels::points; scene::kNone where the surface has no texel (degenerate triangles).
  std::uint32_t point(const scene::Hit& hit) const;

 private:
  struct Use {
    std::uint32_t first = scene::kNone;  ///< its triangle 0 in triangles_
    std::uint32_t page = 0;
  };

  int width_, height_;
  std::vector<Use> uses_;                       ///< by instance
  std::vector<std::array<Vec2, 3>> triangles_;  ///< corners in texels of the page
  std::vector<std::uint32_t> point_of_;         ///< by texel of all pages
};

}  // namespace relume::transport
