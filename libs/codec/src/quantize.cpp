// SPDX-License-Identifier: MIT
#include "relume/codec/quantize.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "relume/core/check.h"

namespace relume::codec {
namespace {

constexpr std::uint32_t kSignBit = 0x80000000u;
constexpr std::uint32_t kFloatInfinity = 0x7f800000u;
constexpr std::uint32_t kHalfOverflow = 0x47800000u;  // 2^16
constexpr std::uint32_t kHalfNormal = 0x38800000u;    // 2^-14, the smallest normal half
constexpr std::uint32_t kBiasChange = (127u - 15u) << 23;

template <class Q>
Q unormFromFloat(float x, float lo, float hi, double max) {
  RELUME_CHECK_LE(lo, hi);
  if (lo == hi) return 0;
  const double t = (static_cast<double>(x) - lo) / (static_cast<double>(hi) - lo);
  return static_cast<Q>(std::lround(std::clamp(t, 0.0, 1.0) * max));
}

float floatFromUnorm(double q, double max, float lo, float hi) {
  return static_cast<float>(lo + q / max * (static_cast<double>(hi) - lo));
}

}  // namespace

std::uint16_t halfFromFloat(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t magnitude = bits & ~kSignBit;
  const std::uint32_t sign = (bits & kSignBit) >> 16;
  std::uint32_t half;
  if (magnitude > kFloatInfinity) {
    half = 0x7e00u;
  } else if (magnitude >= kHalfOverflow) {
    half = 0x7c00u;
  } else if (magnitude < kHalfNormal) {
    // Floats in [0.5, 1) are 2^-24 apart, as denormal halves are: the addition rounds as IEEE 754 asks.
    half = std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) + 0.5f) -
           std::bit_cast<std::uint32_t>(0.5f);
  } else {
    // Adding just under half a unit, and one more where the kept part is odd, rounds ties to even; a carry
    // moves the exponent.
    const std::uint32_t odd = (magnitude >> 13) & 1u;
    half = (magnitude - kBiasChange + 0xfffu + odd) >> 13;
  }
  return static_cast<std::uint16_t>(sign | half);
}

float floatFromHalf(std::uint16_t h) {
  const std::uint32_t sign = (h & 0x8000u) << 16;
  const std::uint32_t magnitude = h & 0x7fffu;
  std::uint32_t bits;
  if (magnitude >= 0x7c00u) {
    bits = kFloatInfinity | ((magnitude & 0x3ffu) << 13);
  } else if (magnitude >= 0x400u) {
    bits = (magnitude << 13) + kBiasChange;
  } else {
    bits = std::bit_cast<std::uint32_t>(static_cast<float>(magnitude) * 0x1p-24f);
  }
  return std::bit_cast<float>(sign | bits);
}

std::uint8_t unorm8FromFloat(float x, float lo, float hi) {
  return unormFromFloat<std::uint8_t>(x, lo, hi, 255);
}
std::uint16_t unorm16FromFloat(float x, float lo, float hi) {
  return unormFromFloat<std::uint16_t>(x, lo, hi, 65535);
}
float floatFromUnorm8(std::uint8_t q, float lo, float hi) { return floatFromUnorm(q, 255, lo, hi); }
float floatFromUnorm16(std::uint16_t q, float lo, float hi) { return floatFromUnorm(q, 65535, lo, hi); }

}  // namespace relume::codec
