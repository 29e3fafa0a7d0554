// SPDX-License-Identifier: MIT
// Directions to a triangle, uniform in solid angle, so that a light near by makes no more noise than one far
// away. Based on:
//   [Arvo95] Arvo. Stratified Sampling of Spherical Triangles. SIGGRAPH 1995.
//   [VOS83] van Oosterom, Strackee. The Solid Angle of a Plane Triangle. IEEE Trans. Biomed. Eng. 1983.
// Computed in double precision. What differs from [Arvo95]: triangles that subtend less than 1e-5 sr, for
// which the construction loses its digits, and those that fill nearly half of the sphere are sampled by area.
#pragma once
#include "relume/core/vec.h"

namespace relume::transport {

struct TriangleSample {
  float b1 = 0, b2 = 0;  ///< barycentrics of the second and third corner
  float pdf = 0;         ///< per steradian; 0: the triangle cannot be seen from there
};

/// `u` in [0, 1)^2.
TriangleSample sampleTriangle(Point from, Point v0, Point v1, Point v2, Vec2 u);

/// The density with which sampleTriangle() chooses direction `d` (unit), which meets the triangle at
/// `distance` metres.
float trianglePdf(Point from, Point v0, Point v1, Point v2, Direction d, float distance);

}  // namespace relume::transport
