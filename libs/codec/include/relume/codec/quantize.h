// SPDX-License-Identifier: MIT
// Numbers in fewer bits, with the error of each kind stated.
#pragma once
#include <cstdint>

namespace relume::codec {

inline constexpr float kHalfMax = 65504.0f;  ///< largest finite float16

/// IEEE 754 binary16, rounded to nearest, ties to even. Relative error at most 2^-11 for 2^-14 <= |x| <=
/// kHalfMax, absolute error at most 2^-25 below; |x| >= 65520 becomes infinite; a NaN stays a NaN.
std::uint16_t halfFromFloat(float x);
/// Exact.
float floatFromHalf(std::uint16_t h);

/// The integers 0..max spread evenly over [lo, hi]: value = lo + q / max * (hi - lo), max = 255 or 65535.
/// Absolute error at most (hi - lo) / (2 max), beyond rounding of the float itself. `x` is clamped to [lo,
/// hi]; needs lo <= hi and x not NaN.
std::uint8_t unorm8FromFloat(float x, float lo, float hi);
std::uint16_t unorm16FromFloat(float x, float lo, float hi);
float floatFromUnorm8(std::uint8_t q, float lo, float hi);
float floatFromUnorm16(std::uint16_t q, float lo, float hi);

}  // namespace relume::codec
