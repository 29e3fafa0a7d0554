// SPDX-License-Identifier: MIT
// Sets of directions that share the sphere evenly, and which of them stands for a direction. Based on:
//   [HP02] Hey, Purgathofer. Real-Time Rendering of Globally Illuminated Soft Glossy Scenes With Directional
//   Light Maps. 2002. Sections 3 and 3.1.
//   [KISS15] Keinert et al. Spherical Fibonacci Mapping. 2015.
//   [Thomson] Thomson's problem: charges on a sphere that push each other away.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "relume/core/vec.h"

namespace relume::basis {

/// n >= 1 directions along a spiral ([KISS15] equation 1).
std::vector<Direction> sphericalFibonacci(std::size_t n);

/// n >= 1 directions of least energy (sum of 1 / distance), from the spiral downhill; the same on every
/// machine to float precision. For n = 6 and 12 the octahedron and the icosahedron, turned.
std::vector<Direction> minimalEnergy(std::size_t n);

/// A direction faces a surface when the cosine is above this. [HP02] asks for above 0; but a map holds
/// E / (N . psi), which has no bound as the cosine goes to 0: what a grazing direction would hold goes to the
/// next nearest.
inline constexpr float kFacing = 0.1f;

/// The direction that stands for `d` at a surface with normal n: the nearest of those that face it ([HP02]
/// section 3.1, where the nearest may face away and its light is lost). The set must have one that faces.
std::size_t nearestFacing(std::span<const Direction> set, Direction d, Normal n);

/// What an 8-bit texture shows of a value: min(k / k_max, 1) ([HP02] section 3.1).
inline float texelOf(float k, float k_max) { return k < k_max ? k / k_max : 1.0f; }

}  // namespace relume::basis
