// SPDX-License-Identifier: MIT
#include "relume/basis/receiver.h"

namespace relume::basis {

Frame tangentFrame(Normal n) {
  static const Frame fixed = Frame::about(Direction(0.36f, 0.48f, 0.8f));
  const Vec3 sum = n + fixed.n;
  const float scale = 1.0f + glm::dot(n, fixed.n);
  if (!(scale > 1e-6f)) return {fixed.t, -fixed.b, n};
  const auto turned = [&](Direction d) { return glm::normalize(d - (glm::dot(d, n) / scale) * sum); };
  const Direction t = turned(fixed.t);
  return {t, glm::cross(n, t), n};
}

}  // namespace relume::basis
