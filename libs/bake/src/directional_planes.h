// SPDX-License-Identifier: MIT
// From what a directional basis has summed up at texels to the planes that the file keeps of it.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/bake/registry.h"
#include "relume/basis/basis.h"

namespace relume::bake {

/// The basis that the parameters "receiver", "packing" and "window" name; null: plain irradiance.
struct Receiver {
  std::shared_ptr<const basis::Basis> basis;
  basis::Packing packing = basis::Packing::kHalf;
};
Receiver receiverOf(const Parameters& parameters);

/// `sums`, shape [points][basis->sums()], as coefficients in planes named after the basis.
std::vector<PointPlane> directionalPlanes(const Receiver& receiver, const atlas::Texels& texels,
                                          std::span<const float> sums);

}  // namespace relume::bake
