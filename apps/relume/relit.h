// SPDX-License-Identifier: MIT
// What the run-time makes of a layer of transfer, as the commands show, write and verify it.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/core/light.h"
#include "relume/image/image.h"
#include "relume/trace/tracer.h"

namespace relume::app {

/// How a layer of transfer is to be lit.
struct Relighting {
  LightSet lights;                        ///< of lightpath
  const trace::Tracer* tracer = nullptr;  ///< whose rays see the lights; null: they are seen everywhere
  std::vector<std::string> gains;      ///< of lightgroups: "group=2" or "group=1,0.5,0"; others are as baked
  std::optional<double> minutes = {};  ///< of a day; none: noon
};

/// Irradiance at the texels of the atlas table: indirect of a lightpath, what was baked of lightgroups,
/// reflected and sky light of a day.
/// Throws Error kNoSuchLayer for a layer that is no transfer, kUsage for a gain of no group.
std::vector<Irradiance> relit(const asset::Asset& asset, const asset::Layer& layer, const Relighting& how);

/// Gives the layer the plane "value" of that irradiance, for pictures.
void addRelitPlane(asset::Asset& asset, const std::string& layer, const Relighting& how);

/// Irradiance at texels as pages below one another, what no surface covers filled from its neighbours.
image::Image toPages(const asset::AtlasTable& atlas, std::span<const Irradiance> irradiance);

/// The first layer that holds transfer, or the one of that name. Throws Error kNoSuchLayer.
asset::Layer& transferLayer(asset::Asset& asset, const std::string& name);

}  // namespace relume::app
