// SPDX-License-Identifier: MIT
#include "relume/basis/sh9.h"

namespace relume::basis {

std::array<float, kSh9> sh9(Direction d) {
  constexpr float k0 = 0.28209479177387814f, k1 = 0.4886025119029199f, k2 = 1.0925484305920792f,
                  k20 = 0.31539156525252005f, k22 = 0.5462742152960396f;
  return {k0,
          k1 * d.y,
          k1 * d.z,
          k1 * d.x,
          k2 * d.x * d.y,
          k2 * d.y * d.z,
          k20 * (3 * d.z * d.z - 1),
          k2 * d.x * d.z,
          k22 * (d.x * d.x - d.y * d.y)};
}

}  // namespace relume::basis
