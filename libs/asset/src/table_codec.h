// SPDX-License-Identifier: MIT
// Tables of layers to and from their descriptions and arrays (docs/format.md, "Tables").
#pragma once
#include "relume/asset/asset.h"
#include "stored_array.h"

namespace relume::asset {

Json encodeTable(const Layer& layer, const Table& table, ArrayWriter& writer);
Table decodeTable(const JsonNode& node, ArrayReader& reader);

}  // namespace relume::asset
