// SPDX-License-Identifier: MIT
// The H-basis: six functions, orthonormal over the hemisphere z >= 0, for irradiance of opaque surfaces.
// Based on:
//   [HW10] Habel, Wimmer. Efficient Irradiance Normal Mapping. I3D 2010. Section 4.
// The factors of hFromSh() are checked by quadrature in the tests: printed ones differ between copies.
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "relume/core/vec.h"

namespace relume::basis {

inline constexpr std::size_t kHMost = 6;

/// H_1 .. H_6 at d in the frame of the surface (z along its normal), sr^(-1/2). The first four are enough for
/// soft light.
std::array<float, kHMost> hValues(Direction d);

/// Least-squares fit over the hemisphere of a function with the SH coefficients `sh` (bands 0 to 2 in the
/// same frame, real signs).
std::array<float, kHMost> hFromSh(std::span<const float, 9> sh);

}  // namespace relume::basis
