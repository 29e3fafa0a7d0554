// SPDX-License-Identifier: MIT
#include "lightmap_truth.h"

#include "relume/core/error.h"

namespace relume::app {

const asset::Layer& lightmapOf(const asset::Asset& asset, const std::string& name) {
  if (name.empty())
    for (const asset::Layer& layer : asset.layers)
      if (layer.kind == "lightmap") return layer;
  if (const asset::Layer* layer = name.empty() ? nullptr : &asset.layer(name);
      layer && layer->kind == "lightmap")
    return *layer;
  throw Error(ErrorCode::kNoSuchLayer, name.empty() ? "the bake" : "layer " + name,
              name.empty() ? "has no lightmap" : "is no lightmap", "bake --layer lightmap");
}

transport::ReferenceOptions truthOf(const asset::Layer& layer, std::uint32_t samples, std::uint64_t seed) {
  const auto word = [&](const char* key) {
    const auto found = layer.parameters.find(key);
    return found == layer.parameters.end() ? std::string() : std::get<std::string>(found->second);
  };
  transport::ReferenceOptions truth;
  truth.samples = samples;
  truth.materials =
      word("materials") == "lambert" ? transport::Materials::kLambert : transport::Materials::kFull;
  truth.part = word("part") == "direct"     ? transport::Part::kDirect
               : word("part") == "indirect" ? transport::Part::kIndirect
                                            : transport::Part::kTotal;
  if (const auto found = layer.parameters.find("bounces"); found != layer.parameters.end())
    if (const double bounces = std::get<double>(found->second); bounces < 1e6)
      truth.max_bounces = static_cast<int>(bounces);
  truth.seed = seed;
  return truth;
}

std::uint64_t independentSeed(std::uint64_t seed) { return seed + 0x5851f42d4c957f2du; }

}  // namespace relume::app
