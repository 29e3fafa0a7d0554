// SPDX-License-Identifier: MIT
// What a person asks for: `name[:key=value[,key=value]...]`.
#pragma once
#include <map>
#include <string>
#include <string_view>

#include "relume/asset/asset.h"

namespace relume::bake {

/// Parameter values by name. After `resolve` (registry.h) every parameter of the layer is present and typed.
using Parameters = std::map<std::string, asset::Parameter>;

struct LayerSpec {
  std::string kind;                           ///< "ao"
  std::map<std::string, std::string> values;  ///< as written
};

/// Parses "ao:distance=2,bent=true". Throws Error kUsage for a malformed text; names are checked by
/// `resolve`.
LayerSpec parseLayerSpec(std::string_view text);

}  // namespace relume::bake
