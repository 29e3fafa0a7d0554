// SPDX-License-Identifier: MIT
#include "relume/picture/baked_values.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "page_texels.h"
#include "relume/core/error.h"

namespace relume::picture {
namespace {

const asset::Plane* findPlane(const asset::Layer& layer, std::string_view name) {
  for (const asset::Plane& plane : layer.planes)
    if (plane.name == name) return &plane;
  return nullptr;
}

bool isObscurance(const asset::Layer& layer) {
  return layer.kind == "obscurance" || layer.kind == "spectral";
}

bool showsTransfer(View view) { return view == View::kRelit || view == View::kIndirect; }

/// An irradiance is no share of anything, nor the other way round.
bool fits(const asset::Layer& layer, View view) {
  if (view == View::kTexels) return true;
  return (view == View::kLightmap) == (layer.kind == "lightmap" || layer.kind == "directional") &&
         showsTransfer(view) == isTransfer(layer);
}

/// What to bake for a view that finds nothing.
const char* remedyFor(View view) {
  if (view == View::kLightmap) return "bake a lightmap";
  if (showsTransfer(view)) return "bake lightpath or lightgroups";
  if (view == View::kBentNormal) return "bake a layer with bent normals, such as ao:bent=true";
  return "bake ao, obscurance or spectral";
}

/// The plane a view shows: of the named layer, or of the first that fits.
struct Chosen {
  const asset::Layer* layer;
  const asset::Plane* plane;
};
Chosen choosePlane(const asset::Asset& asset, View view, const std::string& name,
                   std::string_view plane_name) {
  if (!name.empty()) {
    const asset::Layer& layer = asset.layer(name);
    if (const asset::Plane* plane = findPlane(layer, plane_name)) return {&layer, plane};
    throw Error(ErrorCode::kNoSuchLayer, "layer " + name,
                fmt::format("has no plane '{}', which the view {} shows", plane_name, picture::name(view)),
                "name another layer or choose another view");
  }
  Chosen found{nullptr, nullptr};
  const bool wants_obscurance = view == View::kObscurance || view == View::kLit;
  for (const asset::Layer& layer : asset.layers) {
    const asset::Plane* plane = findPlane(layer, plane_name);
    if (!plane || !fits(layer, view)) continue;
    if (!found.layer) found = {&layer, plane};
    if (!wants_obscurance || isObscurance(layer)) return {&layer, plane};
  }
  if (found.layer) return found;
  throw Error(ErrorCode::kNoSuchLayer, fmt::format("view {}", picture::name(view)),
              fmt::format("no layer of this bake has a plane '{}'", plane_name), remedyFor(view));
}

void requireMatch(const scene::Scene& scene, const asset::AtlasTable& atlas) {
  bool any = false;
  for (const scene::Instance& instance : scene.instances) {
    const scene::Mesh& mesh = scene.meshes[instance.mesh];
    if (instance.dynamic || mesh.atlas_page == scene::kNone) continue;
    any = true;
    const char* remedy = "give the file that the bake was read from";
    if (mesh.atlas_page >= atlas.pages)
      throw Error(ErrorCode::kMismatch, "mesh " + mesh.name,
                  fmt::format("lies on page {} of a bake of {} pages", mesh.atlas_page, atlas.pages), remedy);
    if (mesh.uv[1].size() != mesh.positions.size())
      throw Error(ErrorCode::kMismatch, "mesh " + mesh.name, "is baked but has no TEXCOORD_1", remedy);
  }
  if (!any)
    throw Error(ErrorCode::kMismatch, "scene " + scene.name, "nothing in it lies in the atlas of the bake",
                "give the file that the bake was read from");
}

}  // namespace

bool isTransfer(const asset::Layer& layer) {
  return layer.kind == "lightpath" || layer.kind == "lightgroups" || layer.kind == "day";
}

const asset::Plane& obscurancePlane(const asset::Asset& asset, const std::string& name) {
  const asset::Plane* found = nullptr;
  if (!name.empty()) {
    const asset::Layer& layer = asset.layer(name);
    if (isObscurance(layer)) found = findPlane(layer, "value");
  } else {
    for (const char* kind : {"spectral", "obscurance"})
      for (const asset::Layer& layer : asset.layers)
        if (!found && layer.kind == kind) found = findPlane(layer, "value");
  }
  if (!found)
    throw Error(ErrorCode::kNoSuchLayer, name.empty() ? "the bake" : "layer " + name,
                "holds no obscurance to weight light by", "bake obscurance or spectral");
  if ((found->channels != 1 && found->channels != 3) ||
      found->values.size() != asset.atlas.pageTexels() * static_cast<std::size_t>(found->channels))
    throw Error(ErrorCode::kCorruptAsset, "plane " + found->name, "does not fit the atlas",
                "bake the scene again");
  return *found;
}

BakedValues::BakedValues(const scene::Scene& scene, const asset::Asset* asset, View view,
                         const std::string& layer)
    : scene_(scene), asset_(asset) {
  if (view == View::kAlbedo || view == View::kNormal) {
    asset_ = nullptr;
    return;
  }
  if (!asset)
    throw Error(ErrorCode::kNoSuchLayer, "scene " + scene.name,
                fmt::format("carries no bake, which the view {} shows", name(view)),
                "bake it first, or choose the view albedo or normal");
  requireMatch(scene, asset->atlas);
  if (view == View::kBentNormal)
    bent_ = choosePlane(*asset, view, layer, "bent").plane;
  else if (view != View::kCharts && view != View::kValidity) {
    const Chosen chosen = choosePlane(*asset, view, layer, "value");
    layer_ = chosen.layer, value_ = chosen.plane;
  }

  const std::size_t texels = static_cast<std::size_t>(asset->atlas.pages) *
                             static_cast<std::size_t>(asset->atlas.width) *
                             static_cast<std::size_t>(asset->atlas.height);
  const std::size_t entries = asset->atlas.texel.size();
  bool sound = asset->atlas.chart.size() == entries && asset->atlas.valid.size() == entries;
  for (const asset::Plane* plane : {value_, bent_})
    if (plane)
      sound &=
          plane->channels > 0 && plane->values.size() == texels * static_cast<std::size_t>(plane->channels);
  if (bent_) sound &= bent_->channels == 3;
  if (!sound)
    throw Error(ErrorCode::kCorruptAsset, "bake of " + scene.name,
                fmt::format("planes or tables do not fit {} pages of {} x {} texels", asset->atlas.pages,
                            asset->atlas.width, asset->atlas.height),
                "bake the scene again");
}

std::optional<BakedValues::Place> BakedValues::locate(const scene::Hit& hit) const {
  if (!asset_) return std::nullopt;
  const scene::Instance& instance = scene_.instances[hit.instance];
  const scene::Mesh& mesh = scene_.meshes[instance.mesh];
  if (instance.dynamic || mesh.atlas_page == scene::kNone) return std::nullopt;
  const Vec2 uv = scene::textureCoordinate(scene_, hit, 1);
  return Place{mesh.atlas_page, uv * Vec2(asset_->atlas.width, asset_->atlas.height)};
}

Vec3 BakedValues::bilinear(const asset::Plane& plane, const Place& place) const {
  const Bilinear at = bilinearAt(place.texel, asset_->atlas.width, asset_->atlas.height);
  const std::size_t page = std::size_t{place.page} * static_cast<std::size_t>(asset_->atlas.width) *
                           static_cast<std::size_t>(asset_->atlas.height);
  const auto channels = static_cast<std::size_t>(plane.channels);
  const auto texel = [&](std::size_t k) {
    const float* v = plane.values.data() + (page + at.texel[k]) * channels;
    return channels >= 3 ? Vec3(v[0], v[1], v[2]) : Vec3(v[0]);
  };
  Vec3 sum(0.0f);
  for (std::size_t k = 0; k < 4; ++k) sum += at.weight[k] * texel(k);
  return sum;
}

Vec3 BakedValues::value(const Place& place) const { return value_ ? bilinear(*value_, place) : Vec3(1.0f); }

Vec3 BakedValues::obscurance(const Place& place) const {
  return obscurance_ ? bilinear(*obscurance_, place) : Vec3(1.0f);
}

Normal BakedValues::bentNormal(const Place& place, Normal fallback) const {
  if (!bent_) return fallback;
  const Vec3 n = bilinear(*bent_, place);
  const float length = glm::length(n);
  return length > 1e-6f ? n / length : fallback;
}

std::optional<std::uint32_t> BakedValues::tableIndex(const Place& place) const {
  const asset::AtlasTable& atlas = asset_->atlas;
  const auto x = static_cast<std::uint32_t>(clampIndex(place.texel.x, atlas.width - 1));
  const auto y = static_cast<std::uint32_t>(clampIndex(place.texel.y, atlas.height - 1));
  const std::uint32_t texel =
      (place.page * static_cast<std::uint32_t>(atlas.height) + y) * static_cast<std::uint32_t>(atlas.width) +
      x;
  const auto found = std::lower_bound(atlas.texel.begin(), atlas.texel.end(), texel);
  if (found == atlas.texel.end() || *found != texel) return std::nullopt;
  return static_cast<std::uint32_t>(found - atlas.texel.begin());
}

}  // namespace relume::picture
