// SPDX-License-Identifier: MIT
// Places on surfaces in a fraction of their size, for the atlas and for entries of light.
//   position   = origin + step q, q < 2^23: on a flat chart successive q differ by constants, which Zstandard
//   likes and the bits of
//                floats hide. The step is a power of two.
//   normal     octahedral map ([MMESST14] section 3), two integers of 16 bits; the axes are exact.
// Based on:
//   [MMESST14] Cigolle et al. A Survey of Efficient Representations for Independent Unit Vectors. JCGT 3(2),
//   2014.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "relume/core/vec.h"

namespace relume::asset {

struct Grid {
  Point origin{0.0f};
  float step = 1.0f;  ///< metres
};

/// The finest grid with positions of 23 bits, but of steps of at least `coarsest / 2` where that is coarser
/// (metres): its step is 2^-23 to 2^-22 of the largest extent, float32's spacing at its far end. Throws Error
/// kInvalidValue about `what` and its number where a position is not finite.
Grid gridOf(const std::vector<Point>& positions, const char* what, float coarsest = 0);

/// shape: [positions][3]
std::vector<std::uint32_t> encodePositions(const std::vector<Point>& positions, const Grid& grid);
Point decodePosition(const std::uint32_t* q, const Grid& grid);

inline constexpr std::uint16_t kOctahedralLast = 65534;

/// shape: [normals][2]. Throws Error kInvalidValue about `what` and its number where a normal's length is far
/// from 1.
std::vector<std::uint16_t> encodeNormals(const std::vector<Normal>& normals, const char* what);
/// q: 2 numbers, at most kOctahedralLast
Normal decodeNormal(const std::uint16_t* q);

}  // namespace relume::asset
