// SPDX-License-Identifier: MIT
// Patches of classical radiosity: square blocks of an atlas' texels, each taken to send out the same light
// all over. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.2.1.
// Limits: a patch is the front of a surface; light that falls on backs is lost.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "relume/atlas/texels.h"

namespace relume::transport {

struct Patch {
  std::uint32_t first = 0, count = 0;  ///< into Patches::members
  std::uint32_t chart = 0, page = 0;
  std::uint32_t x = 0, y = 0;  ///< of its block in the page, in blocks
  Point centre{0};             ///< a place on the surface in the middle
  Normal normal{0, 0, 1};      ///< mean of the texels' shading normals
  Normal geometric_normal{0, 0, 1};
  float area = 0;  ///< m^2, of its members
};

struct Patches {
  std::uint32_t side = 0;               ///< texels along a block
  std::vector<Patch> all;               ///< by page, row and column of blocks
  std::vector<std::uint32_t> members;   ///< indices into Texels::points; 4 x 4 blocks of texels together
  std::vector<std::uint32_t> patch_of;  ///< by point

  std::size_t size() const { return all.size(); }
  std::span<const std::uint32_t> membersOf(std::size_t patch) const {
    return std::span(members).subspan(all[patch].first, all[patch].count);
  }
  /// Calls visit with runs of members that lie in one 4 x 4 block of texels, in order.
  void forEachGroup(const atlas::Texels& texels, std::size_t patch,
                    const std::function<void(std::span<const std::uint32_t>)>& visit) const;
  /// Area-weighted means over members; values: by point.
  std::vector<Vec3> means(const atlas::Texels& texels, std::span<const Vec3> values) const;
};

/// Texels of one chart in a block of side x side, divided where normals turn by more than 45 degrees (charts
/// may go round edges). `buried`, by point: texels inside other geometry, which are no members of their patch
/// unless it has no other. side > 0.
Patches makePatches(const atlas::Texels& texels, std::uint32_t side, std::span<const std::uint8_t> buried);

/// The patches of twice the side, by the numbers of their parts.
struct Parents {
  std::vector<std::uint32_t> of;  ///< by patch
  std::vector<float> area;        ///< m^2, by parent
  /// Area-weighted means over parts; values: by patch.
  std::vector<Vec3> means(const Patches& patches, std::span<const Vec3> values) const;
};
Parents parentsOf(const Patches& patches);

}  // namespace relume::transport
