// SPDX-License-Identifier: MIT
// Look-ups of directional light: what a texel's basis holds at a place between texels.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/asset/direction_maps.h"
#include "relume/basis/basis.h"
#include "relume/picture/baked_values.h"

namespace relume::picture {

/// Whether a layer knows light by direction.
bool isDirectional(const asset::Layer& layer);

class BakedDirections {
 public:
  /// Keeps references. Throws Error kCorruptAsset where planes are missing or of the wrong shape,
  /// kUnsupported for a receiver that is not known here.
  BakedDirections(const asset::Layer& layer, const asset::AtlasTable& atlas);

  const basis::Basis& basis() const { return *basis_; }
  /// Coefficients there, shape [basis().coefficients()]: what is stored, bilinear, then unpacked. False where
  /// a layer that keeps charts by direction has no chart.
  bool coefficients(const BakedValues& baked, const BakedValues::Place& place, std::span<float> out) const;

  static constexpr std::size_t kMost = 256;  ///< coefficients of any basis

 private:
  bool fromMaps(const BakedValues& baked, const BakedValues::Place& place, std::span<float> out) const;

  asset::DirectionMaps maps_;  // of a layer `directional`; otherwise empty
  std::unique_ptr<basis::Basis> basis_;
  basis::Packing packing_ = basis::Packing::kHalf;
  std::vector<const asset::Plane*> planes_;
  int width_, height_;
};

}  // namespace relume::picture
