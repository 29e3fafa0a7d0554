// SPDX-License-Identifier: MIT
// Random numbers as a pure function of (seed, item, sample, dimension): hash-based Owen-scrambled Sobol
// points, and warps of the unit square. Nothing here has state. Based on:
//   [Burley20] Burley. Practical Hash-based Owen Scrambling. JCGT 9(4), 2020.
//   [Shirley97] Shirley, Chiu. A Low Distortion Map Between Disk and Square. 1997.
#pragma once
#include <cstdint>

#include "relume/core/vec.h"

namespace relume {

/// A 32-bit mix of two words; every bit of the result depends on every bit of both.
std::uint32_t hashCombine(std::uint32_t a, std::uint32_t b);

/// Sample `index` of an Owen-scrambled two-dimensional Sobol sequence, in [0, 1)^2. Every `stream` is an
/// independent scramble with shuffled order; each aligned power-of-two run of indices is a (0, m, 2)-net
/// ([Burley20]).
Vec2 sobol2(std::uint32_t index, std::uint32_t stream);

/// The same for many indices of one stream: Sobol2(stream)(index) == sobol2(index, stream).
class Sobol2 {
 public:
  explicit Sobol2(std::uint32_t stream)
      : order_(hashCombine(stream, 0x68bc21ebu)),
        first_(hashCombine(stream, 0x02e5be93u)),
        second_(hashCombine(stream, 0x967a889bu)) {}
  Vec2 operator()(std::uint32_t index) const;

 private:
  std::uint32_t order_, first_, second_;  // seeds of scrambles
};

/// The stream of (seed, item, dimension pair).
inline std::uint32_t streamOf(std::uint64_t seed, std::uint32_t item, std::uint32_t dimension_pair) {
  return hashCombine(
      hashCombine(static_cast<std::uint32_t>(seed) ^ hashCombine(static_cast<std::uint32_t>(seed >> 32), 1u),
                  item),
      dimension_pair);
}

/// Area-preserving map of the unit square to the unit disk ([Shirley97]).
Vec2 squareToDisk(Vec2 u);
/// Cosine-weighted direction about +z (Malley); pdf = cos / pi. The z component is at least 1e-4, so no ray
/// lies in the plane.
Direction squareToCosineHemisphere(Vec2 u);
/// Uniform direction on the sphere; pdf = 1 / (4 pi).
Direction squareToSphere(Vec2 u);

}  // namespace relume
