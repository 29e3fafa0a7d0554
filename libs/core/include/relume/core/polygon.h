// SPDX-License-Identifier: MIT
// Flat polygons in space: their area and normal, and their triangles. Based on:
//   [Mei75] Meisters. Polygons Have Ears. The American Mathematical Monthly 82(6), 1975.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "relume/core/vec.h"

namespace relume {

/// Along the normal of the side from which the corners go counter-clockwise, as long as the area in m^2; of
/// corners that do not lie in a plane, that of their shadow where it is largest.
glm::dvec3 areaVector(std::span<const Point> corners);

/// Triangles that cover the polygon, facing as it does, by cutting off ears [Mei75]; corners on a straight
/// line are passed over. At most corners - 2. None when the polygon has no area or its outline meets itself
/// (beyond float precision; in the plane of its area vector). Takes time in the
/// square of the corners, of odd outlines more.
std::vector<std::array<Point, 3>> triangulate(std::span<const Point> corners);

}  // namespace relume
