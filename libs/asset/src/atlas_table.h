// SPDX-License-Identifier: MIT
// AtlasTable to and from its description and arrays (docs/format.md, "Atlas").
#pragma once
#include "relume/asset/asset.h"
#include "stored_array.h"

namespace relume::asset {

inline constexpr std::uint64_t kMaxSide = 1u << 16, kMaxPages = 1u << 12;

Json encodeAtlas(const AtlasTable& atlas, ArrayWriter& writer);
AtlasTable decodeAtlas(const JsonNode& node, ArrayReader& reader);

}  // namespace relume::asset
