// SPDX-License-Identifier: MIT
// Real spherical harmonics of bands 0 to 2: orthonormal, no Condon-Shortley sign, pole +z. Based on:
//   [RH01] Ramamoorthi, Hanrahan. An Efficient Representation for Irradiance Environment Maps. 2001.
#pragma once
#include <array>
#include <cstddef>

#include "relume/core/vec.h"

namespace relume::basis {

inline constexpr std::size_t kSh9 = 9;

/// Y_lm(d), sr^(-1/2) ([RH01] equation 3), index l * l + l + m. The squares sum to 9 / (4 pi) for every d.
std::array<float, kSh9> sh9(Direction d);

/// A_l by index: irradiance E(n) = sum A_l L_lm Y_lm(n) of incident radiance with coefficients L_lm ([RH01]
/// equation 8: pi, 2 pi / 3, pi / 4), in error by 1 % on average and 9 % at most where light comes from one
/// direction. It can be slightly negative (ringing).
inline constexpr std::array<float, kSh9> kCosineLobe = {
    kPi, 2 * kPi / 3, 2 * kPi / 3, 2 * kPi / 3, kPi / 4, kPi / 4, kPi / 4, kPi / 4, kPi / 4};

}  // namespace relume::basis
