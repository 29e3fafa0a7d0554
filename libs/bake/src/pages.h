// SPDX-License-Identifier: MIT
// From values at points to finished planes over whole pages: scatter, dilate, stitch seams, clamp.
#pragma once
#include <span>

#include "relume/asset/asset.h"
#include "relume/atlas/texels.h"
#include "relume/bake/registry.h"
#include "relume/bake/report.h"

namespace relume::bake {

/// shape of the result: [pages * height * width][channels]
/// Where `report` is not null, its seam errors are set to those of this plane.
asset::Plane finishPlane(const atlas::Texels& texels, std::span<const atlas::SeamSample> seams,
                         std::span<const std::uint8_t> valid, PointPlane plane,
                         LayerReport* report = nullptr);

}  // namespace relume::bake
