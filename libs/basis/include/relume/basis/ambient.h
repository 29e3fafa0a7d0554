// SPDX-License-Identifier: MIT
// Small sets of directions with weights that blend what is known along them: Half-Life 2's basis, the ambient
// cube, the ambient dice. Based on:
//   [RTR] Akenine-Moeller, Haines, Hoffman. Real-Time Rendering, 3rd ed. Section 11.5.2.
//   [McT04] McTaggart. Half-Life 2 / Valve Source Shading. GDC 2004.
//   [IS17] Iwanicki, Sloan. Ambient Dice. EGSR 2017 (the blend of cos^2 and cos^4 as public copies have it).
#pragma once
#include <array>

#include "relume/core/vec.h"

namespace relume::basis {

/// Tangent space, orthonormal, 54.7 degrees from the normal z.
inline constexpr std::array<Direction, 3> kHl2 = {
    Direction(0.816496580927726f, 0, 0.5773502691896258f),
    Direction(-0.408248290463863f, 0.7071067811865476f, 0.5773502691896258f),
    Direction(-0.408248290463863f, -0.7071067811865476f, 0.5773502691896258f)};
/// (n . b_i)+^2, made to sum to 1: exact at the vectors, and for light that is the same along all of them.
/// n in tangent space, z > -0.57.
std::array<float, 3> hl2Weights(Direction n);
/// (n . b_i)+ as it is: too bright, by the square root of 3 for n = z.
std::array<float, 3> hl2PlainWeights(Direction n);

/// +x, -x, +y, -y, +z, -z
inline constexpr std::array<Direction, 6> kCube = {Direction(1, 0, 0), Direction(-1, 0, 0),
                                                   Direction(0, 1, 0), Direction(0, -1, 0),
                                                   Direction(0, 0, 1), Direction(0, 0, -1)};
/// n_i^2 of the three faces that n turns to; sums to 1.
std::array<float, 6> cubeWeights(Direction n);

/// Corners of an icosahedron.
inline constexpr float kDiceA = 0.8506508083520399f, kDiceB = 0.5257311121191336f;
inline constexpr std::array<Direction, 12> kDice = {
    Direction(kDiceA, kDiceB, 0),   Direction(-kDiceA, kDiceB, 0),  Direction(kDiceA, -kDiceB, 0),
    Direction(-kDiceA, -kDiceB, 0), Direction(0, kDiceA, kDiceB),   Direction(0, -kDiceA, kDiceB),
    Direction(0, kDiceA, -kDiceB),  Direction(0, -kDiceA, -kDiceB), Direction(kDiceB, 0, kDiceA),
    Direction(-kDiceB, 0, kDiceA),  Direction(kDiceB, 0, -kDiceA),  Direction(-kDiceB, 0, -kDiceA)};
/// 0.35 cos^2 + 0.25 cos^4 of the six corners that n turns to; sums to 1.
std::array<float, 12> diceWeights(Direction n);

}  // namespace relume::basis
