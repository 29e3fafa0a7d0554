// SPDX-License-Identifier: MIT
// How far high bands must fade so that nothing negative is left: Sloan's window, as little of it as it takes.
// Based on:
//   [Slo08] Sloan. Stupid Spherical Harmonics (SH) Tricks. GDC 2008. Windowing.
#pragma once
#include <algorithm>
#include <vector>

#include "relume/basis/direction_set.h"
#include "relume/basis/receiver.h"

namespace relume::basis {

/// The least lambda of a ladder, each step twice the last, for which `lowest(lambda)` is not below 0; at the
/// end of it next to nothing but the constant is left.
template <class Lowest>
float leastWindow(const Lowest& lowest) {
  constexpr float kFirst = 1e-3f, kLast = 1e3f;
  if (lowest(0.0f) >= 0) return 0.0f;
  float lambda = kFirst;
  while (lambda < kLast && lowest(lambda) < 0) lambda *= 2;
  return lambda;
}

/// Normals of the hemisphere, in the frame of the surface.
inline const std::vector<Normal>& hemisphereNormals() {
  static const std::vector<Normal> normals = [] {
    std::vector<Normal> all;
    for (const Direction d : sphericalFibonacci(128))
      if (d.z > 0) all.push_back(d);
    return all;
  }();
  return normals;
}

}  // namespace relume::basis
