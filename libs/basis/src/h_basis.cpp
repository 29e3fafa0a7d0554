// SPDX-License-Identifier: MIT
#include "relume/basis/h_basis.h"

namespace relume::basis {

std::array<float, kHMost> hValues(Direction d) {
  constexpr float k1 = 0.3989422804014327f;  // 1 / sqrt(2 pi)
  constexpr float k2 = 0.6909882989426709f;  // sqrt(3 / 2 pi)
  constexpr float k5 = 1.5450968080927583f;  // sqrt(15 / 2 pi)
  return {k1, k2 * d.y, k2 * (2 * d.z - 1), k2 * d.x, k5 * d.x * d.y, 0.5f * k5 * (d.x * d.x - d.y * d.y)};
}

std::array<float, kHMost> hFromSh(std::span<const float, 9> sh) {
  constexpr float r = 0.7071067811865476f;  // 1 / sqrt 2
  constexpr float a = 0.6123724356957945f;  // sqrt(3/2) / 2
  constexpr float b = 0.592927061281571f;   // 3/8 sqrt(5/2)
  constexpr float c = 0.6846531968814576f;  // 1/4 sqrt(15/2)
  return {r * sh[0] + a * sh[2],
          r * sh[1] + b * sh[5],
          0.5f * r * sh[2] + c * sh[6],
          r * sh[3] + b * sh[7],
          r * sh[4],
          r * sh[8]};
}

}  // namespace relume::basis
