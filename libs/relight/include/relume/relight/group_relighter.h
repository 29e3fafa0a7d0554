// SPDX-License-Identifier: MIT
// Relighting with light groups: lamps that are dimmed, coloured and switched.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/core/quantity.h"

namespace relume::relight {

/// E[texel] = sum over groups of gain[group] E_group[texel], colour by colour: the lamps of a group as they
/// were baked have gain 1. Groups of gain 0 cost nothing. The result depends on the gains alone.
class GroupRelighter {
 public:
  /// One group for each plane of 3 channels, of the plane's name. Throws Error kMismatch where `layer` has
  /// none or is not of kind lightgroups.
  GroupRelighter(const asset::Asset& asset, const asset::Layer& layer);

  std::size_t texelCount() const { return result_.size(); }
  std::size_t groupCount() const { return names_.size(); }
  const std::vector<std::string>& groupNames() const { return names_; }

  /// gains: [groups], by colour. Shape: [texels of the atlas table]; valid until the next call. Throws Error
  /// kInvalidValue for a gain that is negative or not finite, and keeps what was; allocates nothing after the
  /// first call.
  std::span<const Irradiance> evaluate(std::span<const Vec3> gains);

 private:
  std::vector<std::string> names_;
  std::vector<std::array<std::vector<float>, 3>> values_;  ///< of each group and channel: [texels]
  std::vector<Irradiance> result_;
};

}  // namespace relume::relight
