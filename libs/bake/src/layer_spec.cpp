// SPDX-License-Identifier: MIT
#include "relume/bake/layer_spec.h"

#include "relume/core/error.h"

namespace relume::bake {

LayerSpec parseLayerSpec(std::string_view text) {
  const auto malformed = [&](const std::string& why) {
    return Error(ErrorCode::kUsage, "--layer " + std::string(text), why,
                 "write for example --layer ao:distance=2");
  };
  const std::size_t colon = text.find(':');
  LayerSpec spec{.kind = std::string(text.substr(0, colon)), .values = {}};
  if (spec.kind.empty()) throw malformed("names no layer");
  if (colon == std::string_view::npos) return spec;
  std::string_view rest = text.substr(colon + 1);
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == item.size())
      throw malformed("'" + std::string(item) + "' is not key=value");
    if (!spec.values.emplace(item.substr(0, equals), item.substr(equals + 1)).second)
      throw malformed("'" + std::string(item.substr(0, equals)) + "' is given twice");
    if (comma == std::string_view::npos) return spec;
    rest = rest.substr(comma + 1);
  }
}

}  // namespace relume::bake
