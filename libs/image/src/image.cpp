// SPDX-License-Identifier: MIT
// The sRGB transfer function of IEC 61966-2-1. Values outside [0, 1] continue the same branches, so the two
// are inverse to each other everywhere.
#include "relume/image/image.h"

#include <cmath>

namespace relume::image {

float srgbToLinear(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }

float linearToSrgb(float l) {
  return l <= 0.0031308f ? 12.92f * l : 1.055f * std::pow(l, 1.0f / 2.4f) - 0.055f;
}

}  // namespace relume::image
