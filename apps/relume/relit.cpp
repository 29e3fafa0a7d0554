// SPDX-License-Identifier: MIT
#include "relit.h"

#include <fmt/format.h>

#include <algorithm>

#include "files.h"
#include "relume/atlas/texels.h"
#include "relume/core/error.h"
#include "relume/picture/picture.h"
#include "relume/relight/day_relighter.h"
#include "relume/relight/group_relighter.h"
#include "relume/relight/transfer_relighter.h"
#include "shadows.h"

namespace relume::app {

asset::Layer& transferLayer(asset::Asset& asset, const std::string& name) {
  if (!name.empty()) {
    asset.layer(name);  // says which there are
    const auto named = [&](const asset::Layer& layer) { return layer.name == name; };
    return *std::find_if(asset.layers.begin(), asset.layers.end(), named);
  }
  const auto found = std::find_if(asset.layers.begin(), asset.layers.end(), picture::isTransfer);
  if (found == asset.layers.end())
    throw Error(ErrorCode::kNoSuchLayer, "the bake", "has no layer that follows lamps", "bake lightpath");
  return *found;
}

namespace {

constexpr double kNoon = 720;  // minutes

std::vector<Vec3> gainsOf(const relight::GroupRelighter& relighter, const std::vector<std::string>& given) {
  const std::vector<std::string>& names = relighter.groupNames();
  std::vector<Vec3> gains(names.size(), Vec3(1.0f));
  for (const std::string& text : given) {
    const std::size_t equals = text.rfind('=');
    const auto found = std::find(names.begin(), names.end(), text.substr(0, equals));
    if (equals == std::string::npos || found == names.end())
      throw Error(ErrorCode::kUsage, "--gain " + text, "names no group of lights",
                  fmt::format("write GROUP=NUMBER or GROUP=R,G,B; there are {}", fmt::join(names, ", ")));
    gains[static_cast<std::size_t>(found - names.begin())] =
        parseTriple(text.substr(equals + 1), "--gain " + text, true);
  }
  return gains;
}

}  // namespace

std::vector<Irradiance> relit(const asset::Asset& asset, const asset::Layer& layer, const Relighting& how) {
  if (layer.kind == "lightgroups") {
    relight::GroupRelighter relighter(asset, layer);
    const std::span<const Irradiance> texels = relighter.evaluate(gainsOf(relighter, how.gains));
    return {texels.begin(), texels.end()};
  }
  if (layer.kind == "day") {
    relight::DayRelighter relighter(asset, layer);
    if (relighter.frames().receivers != asset::DayFrames::Receivers::kAtlas)
      throw Error(ErrorCode::kMismatch, "layer " + layer.name, "knows the pixels of one camera and no texels",
                  "bake day:receivers=atlas");
    const std::span<const Irradiance> texels = relighter.evaluate(how.minutes.value_or(kNoon));
    return {texels.begin(), texels.end()};
  }
  relight::TransferRelighter relighter(asset, layer);
  relight::VisibilitySource visibility;
  if (how.tracer)
    visibility = tracedVisibility(*how.tracer, relighter.visibilityPoints(), relighter.visibilityNormals(),
                                  how.lights);
  const std::span<const Irradiance> texels = relighter.evaluate(how.lights, visibility);
  return {texels.begin(), texels.end()};
}

void addRelitPlane(asset::Asset& asset, const std::string& layer, const Relighting& how) {
  asset::Layer& transfer = transferLayer(asset, layer);
  const image::Image pages = toPages(asset.atlas, relit(asset, transfer, how));
  transfer.planes.insert(
      transfer.planes.begin(),
      {.name = "value", .channels = 3, .storage = asset::Storage::kFloat32, .values = pages.data});
}

image::Image toPages(const asset::AtlasTable& atlas, std::span<const Irradiance> irradiance) {
  image::Image pages(atlas.width, atlas.height * static_cast<int>(atlas.pages), 3);
  std::vector<std::uint8_t> covered(pages.pixels(), 0);
  for (std::size_t i = 0; i < atlas.texel.size(); ++i) {
    const std::size_t texel = atlas.texel[i];
    for (int c = 0; c < 3; ++c) pages.data[texel * 3 + static_cast<std::size_t>(c)] = irradiance[i].rgb[c];
    covered[texel] = 1;
  }
  atlas::dilate(atlas.width, atlas.height, atlas.pages, 3, pages.data, std::move(covered));
  return pages;
}

}  // namespace relume::app
