// SPDX-License-Identifier: MIT
#include "relume/basis/ambient.h"

#include <algorithm>

namespace relume::basis {

std::array<float, 3> hl2PlainWeights(Direction n) {
  std::array<float, 3> w;
  for (std::size_t i = 0; i < w.size(); ++i) w[i] = std::max(glm::dot(n, kHl2[i]), 0.0f);
  return w;
}

std::array<float, 3> hl2Weights(Direction n) {
  std::array<float, 3> w = hl2PlainWeights(n);
  for (float& x : w) x *= x;
  const float sum = w[0] + w[1] + w[2];
  for (float& x : w) x = sum > 0 ? x / sum : 1.0f / 3;
  return w;
}

std::array<float, 6> cubeWeights(Direction n) {
  std::array<float, 6> w;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(2 * axis);
    w[i] = n[axis] > 0 ? n[axis] * n[axis] : 0.0f;
    w[i + 1] = n[axis] > 0 ? 0.0f : n[axis] * n[axis];
  }
  return w;
}

std::array<float, 12> diceWeights(Direction n) {
  std::array<float, 12> w;
  for (std::size_t i = 0; i < w.size(); ++i) {
    const float c = glm::dot(n, kDice[i]), cc = c * c;
    w[i] = c > 0 ? cc * (0.35f + 0.25f * cc) : 0.0f;
  }
  return w;
}

}  // namespace relume::basis
