// SPDX-License-Identifier: MIT
// Texels that lie together, whose rays are traced together.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "relume/atlas/texels.h"
#include "texel_rows.h"

namespace relume::transport {

inline constexpr std::uint32_t kGroupSide = 4;
inline constexpr std::uint32_t kGroupTexels = kGroupSide * kGroupSide;

/// Divides the points of an atlas in groups: those of one chart inside one 4 x 4 block of a page. The groups
/// depend on the atlas alone; they come in tiles, the items of a parallel loop.
class TexelGroups {
 public:
  explicit TexelGroups(const atlas::Texels& texels);

  std::size_t tiles() const;
  /// The tiles, increasing, that hold any of these indices into Texels::points; no index: all of them.
  std::vector<std::size_t> tilesOf(std::span<const std::uint32_t> which) const;
  /// Calls visit with the indices into Texels::points of each group of the tile, increasing.
  void forEachGroup(std::size_t tile, const std::function<void(std::span<const std::uint32_t>)>& visit) const;

 private:
  static constexpr std::uint32_t kTileBlocks = 16;  // along x

  const atlas::Texels& texels_;
  std::uint32_t tiles_x_ = 0, tiles_y_ = 0;
  TexelRows rows_;
};

}  // namespace relume::transport
