// SPDX-License-Identifier: MIT
// Layers to and from their descriptions and arrays (docs/format.md, "Layers").
#pragma once
#include "relume/asset/asset.h"
#include "stored_array.h"

namespace relume::asset {

Json encodeLayer(const Layer& layer, std::size_t page_texels, ArrayWriter& writer);
Layer decodeLayer(const JsonNode& node, std::size_t page_texels, ArrayReader& reader);

}  // namespace relume::asset
