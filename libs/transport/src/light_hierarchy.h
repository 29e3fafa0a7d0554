// SPDX-License-Identifier: MIT
// Emitters in groups of groups, two by two: what a light tree is made from. Based on:
//   [CK18] Conty Estevez, Kulla. Importance Sampling of Many Lights with Adaptive Tree Splitting. HPG 2018.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light_tree.h"

namespace relume::transport {

struct LightGroup {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  EmitterBounds bounds;
  std::uint32_t second = kNone;  ///< the first half follows its group; kNone: one emitter
  std::uint32_t emitter = 0;
};

/// [CK18] (1): intensity times the measure of directions times the area of the bounds.
float costOf(const EmitterBounds& bounds);

/// The whole comes first; empty when nothing has an intensity.
std::vector<LightGroup> lightHierarchy(std::span<const EmitterBounds> emitters);

}  // namespace relume::transport
