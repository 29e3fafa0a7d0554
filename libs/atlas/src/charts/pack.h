// SPDX-License-Identifier: MIT
// Flat blocks laid into pages without touching.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/core/error.h"
#include "relume/core/progress.h"
#include "relume/core/vec.h"

namespace relume::atlas {

/// What is moved as one: a chart, or a whole layout that came with the mesh. Its uv lie in [0, extent].
struct Block {
  std::span<const Vec2> uv;                ///< per vertex, any unit
  std::span<const UVec3> triangles;        ///< of these vertices
  std::span<const std::uint32_t> members;  ///< the triangles of the block
  Vec2 extent{0.0f};
  double metres = 1;        ///< in the world, per unit of uv
  std::uint32_t group = 0;  ///< blocks of a group lie on one page; groups are numbered from 0
};

/// texel position = page corner + turn(uv * scale + shift): `turns` quarter turns within the block's box.
struct Placement {
  std::uint32_t page = 0;
  IVec2 corner{0};  ///< texels
  IVec2 size{1};    ///< box before it turns, texels
  int turns = 0;
  float scale = 1;   ///< texels per unit of uv
  Vec2 shift{0.0f};  ///< texels, centres the block in its box

  IVec2 turnedSize() const { return turns % 2 == 0 ? size : IVec2(size.y, size.x); }
};
Vec2 place(const Placement& placement, Vec2 uv);

struct PackOptions {
  int page_size = 1024;
  int gutter = 2;
  double texels_per_metre = 0;  ///< 0: as dense as one page allows
};

struct Packing {
  std::vector<Placement> placements;  ///< per block
  std::uint32_t pages = 0;
  double texels_per_metre = 0;
  std::size_t covered = 0;          ///< texels of all footprints
  std::vector<double> group_scale;  ///< 1, or what a group was scaled down by to fit a page
};

/// Deterministic. With a given density as many pages as it takes.
Packing packBlocks(std::span<const Block> blocks, std::uint32_t groups, const PackOptions& options,
                   Progress& progress);

}  // namespace relume::atlas
