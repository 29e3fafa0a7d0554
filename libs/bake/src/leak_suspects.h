// SPDX-License-Identifier: MIT
// Texels that may show light or darkness which is not theirs.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/bake/registry.h"
#include "relume/bake/report.h"

namespace relume::bake {

/// Which point of a page's texel: index into Texels::points, or scene::kNone. shape: [pages * height * width]
std::vector<std::uint32_t> pointsByTexel(const atlas::Texels& texels);

/// Marks every texel of a layer with its signs (SuspectSign, kInvalidMark) and lists those that stand out.
/// Fills stand_out, beside_invalid, see_backs, suspects, marks and invalid_texels of `report`. Needs
/// report.mean_value.
void findSuspects(const atlas::Texels& texels, std::span<const std::uint32_t> point_of_texel,
                  const PointLayer& layer, LayerReport& report);

}  // namespace relume::bake
