// SPDX-License-Identifier: MIT
// The hemicube: half a cube about a point, divided in pixels, each with the form factor from the point to
// what is seen through it. Based on:
//   [CG85] Cohen, Greenberg. The Hemi-Cube: A Radiosity Solution for Complex Environments. SIGGRAPH 1985.
// Differs from it: delta form factors are integrals over pixels (Lambert's formula for a polygon) and not the
// integrand at their middles, so they sum to 1 at any resolution.
#pragma once
#include <cstdint>
#include <vector>

#include "relume/core/vec.h"

namespace relume::transport {

struct HemicubePixel {
  Direction direction;  ///< through the pixel's middle; unit, about +z
  float form_factor;    ///< of a differential area at the cube's centre that faces +z
};

/// The pixels of a top of resolution x resolution and four sides of half that height; blocks of 4 x 4 pixels
/// follow one another. resolution: a multiple of 8.
std::vector<HemicubePixel> hemicube(std::uint32_t resolution);

/// From a differential area at the origin that faces +z to a polygon above its plane whose corners go round
/// as seen from outside clockwise or not: the sign tells. corners: at least 3.
double polygonFormFactor(const std::vector<glm::dvec3>& corners);

}  // namespace relume::transport
