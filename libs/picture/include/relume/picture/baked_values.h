// SPDX-License-Identifier: MIT
// Look-ups of a bake at places on surfaces: bilinear inside the page for values, the nearest texel for what
// cannot be mixed.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "relume/asset/asset.h"
#include "relume/picture/picture.h"
#include "relume/scene/scene.h"

namespace relume::picture {

/// W of the layer of that name, or of the first spectral one, else the first obscurance (PictureOptions).
/// Throws Error kNoSuchLayer, kCorruptAsset.
const asset::Plane& obscurancePlane(const asset::Asset& asset, const std::string& layer);

class BakedValues {
 public:
  /// Chooses the layer that `view` shows and checks that scene and asset belong together; see render() for
  /// what is thrown.
  BakedValues(const scene::Scene& scene, const asset::Asset* asset, View view, const std::string& layer);

  /// What obscurance() looks up from now on.
  void useObscurance(const asset::Plane& plane) { obscurance_ = &plane; }

  /// Where a surface lies in the atlas: page and place in texels, (0, 0) being the corner of texel (0, 0).
  struct Place {
    std::uint32_t page = 0;
    Vec2 texel{0.0f};
  };
  /// Nothing for surfaces without a bake.
  std::optional<Place> locate(const scene::Hit& hit) const;

  /// The layer's value, grey or RGB; 1 where the view has no value plane.
  Vec3 value(const Place& place) const;
  /// W of useObscurance(); 1 without.
  Vec3 obscurance(const Place& place) const;
  /// World, unit; `fallback` where the bake has none (nothing open).
  Normal bentNormal(const Place& place, Normal fallback) const;
  /// Index into the asset's AtlasTable of the texel at that place; nothing when no surface covers it.
  std::optional<std::uint32_t> tableIndex(const Place& place) const;
  const asset::AtlasTable& table() const { return asset_->atlas; }
  /// The layer that the view shows; null without one.
  const asset::Layer* layer() const { return layer_; }
  /// The planes that the view shows, for those who look them up themselves; null where it shows none.
  const asset::Plane* valuePlane() const { return value_; }
  const asset::Plane* bentPlane() const { return bent_; }

 private:
  Vec3 bilinear(const asset::Plane& plane, const Place& place) const;

  const scene::Scene& scene_;
  const asset::Asset* asset_;
  const asset::Layer* layer_ = nullptr;
  const asset::Plane* value_ = nullptr;
  const asset::Plane* bent_ = nullptr;
  const asset::Plane* obscurance_ = nullptr;
};

}  // namespace relume::picture
