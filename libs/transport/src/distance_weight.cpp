// SPDX-License-Identifier: MIT
// The distance weights of obscurance and the interreflection corrections.
// Based on:
//   [IKSZ03] (2), (8); [RTR] (11.13): see relume/transport/occlusion.h.
//   [JWPJ16] Jimenez, Wu, Pesce, Jarabo. Practical Real-Time Strategies for Accurate Indirect Occlusion.
//   2016: the cubic.
#include <algorithm>
#include <cmath>

#include "relume/transport/occlusion.h"

namespace relume::transport {

float DistanceWeight::operator()(float distance) const {
  if (distance >= limit) return 1.0f;
  if (distance <= 0.0f) return 0.0f;
  switch (shape) {
    case Shape::kExponential: {
      const float rise = -std::expm1(-distance / tau);
      return std::isinf(limit) ? rise : std::min(1.0f, rise / -std::expm1(-limit / tau));
    }
    case Shape::kExponentialCut:
      return -std::expm1(-distance / tau);
    case Shape::kLinear:
      return distance / limit;
    case Shape::kSqrt:
      return std::sqrt(distance / limit);
    case Shape::kStep:
      return 0.0f;
  }
  return 1.0f;
}

float correctedStewartLanger(float k, float rho) {
  const float denominator = 1.0f - rho * (1.0f - k);
  // 0/0 at k = 0, rho = 1: no light enters, none is multiplied.
  return denominator > 0.0f ? k / denominator : 0.0f;
}

float correctedJimenez(float k, float rho) {
  const float a = 2.0404f * rho - 0.3324f, b = -4.7951f * rho + 0.6417f, c = 2.7552f * rho + 0.6903f;
  return std::max(k, ((a * k + b) * k + c) * k);
}

}  // namespace relume::transport
