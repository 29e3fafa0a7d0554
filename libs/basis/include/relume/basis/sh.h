// SPDX-License-Identifier: MIT
// Real spherical harmonics of bands 0 to 4: orthonormal, no Condon-Shortley sign, pole +z, index l * l + l +
// m (sh9.h has bands 0 to 2 for loops that are in a hurry). Based on:
//   [RH01] Ramamoorthi, Hanrahan. An Efficient Representation for Irradiance Environment Maps. 2001.
//   [Slo08] Sloan. Stupid Spherical Harmonics (SH) Tricks. GDC 2008: signs of graphics, windowing.
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "relume/core/quantity.h"

namespace relume::basis {

inline constexpr std::size_t kShBands = 5, kShMost = kShBands * kShBands;

inline constexpr std::size_t bandOf(std::size_t index) {
  std::size_t band = 0;
  while ((band + 1) * (band + 1) <= index) ++band;
  return band;
}

/// Y_lm(d), sr^(-1/2), of the first `values.size()` functions (1, 4, 9, 16 or 25).
void shValues(Direction d, std::span<float> values);

/// -1 for the functions (m odd) whose sign the Condon-Shortley phase turns, as in Direct3D and [Slo08];
/// multiply coefficients by it on the way to or from such programs.
inline constexpr float condonShortley(std::size_t index) {
  const std::size_t band = bandOf(index), m = index - band * band + band;  // m + 2 band: the same parity as m
  return m % 2 == 1 ? -1.0f : 1.0f;
}

/// A_l: irradiance has coefficients A_l L_lm ([RH01] equations 8 and 9). Odd bands but the first are 0.
inline constexpr std::array<float, 9> kCosineFactor = {kPi, 2 * kPi / 3, kPi / 4, 0,         -kPi / 24,
                                                       0,   kPi / 64,    0,       -kPi / 128};

/// E(n) of incident radiance; `radiance`: RGB by index, [functions][3]. Slightly negative where it rings.
Irradiance shIrradiance(std::span<const float> radiance, Normal n);

/// Factor of a band in a window that fades high bands out: 1 / (1 + lambda l^2 (l + 1)^2) ([Slo08], which
/// minimizes the squared Laplacian). lambda 0: none.
inline float windowFactor(std::size_t band, float lambda) {
  const auto l = static_cast<float>(band);
  return 1.0f / (1.0f + lambda * l * l * (l + 1) * (l + 1));
}

}  // namespace relume::basis
