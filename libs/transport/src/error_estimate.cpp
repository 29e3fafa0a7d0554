// SPDX-License-Identifier: MIT
// A scrambled net of n samples has one in each cell of a grid. Were these independent, the variance of the
// mean would be the sum over cells of the variance inside a cell over n^2. The mixed difference of a 2 x 2
// block,
//   d = r00 - r01 - r10 + r11,
// estimates the sum of its four cells' variances: a linear course of the integrand cancels, an edge that
// crosses cells remains. Taken over all blocks, V = (n / blocks) sum d^2 / n^2 / 4, it falls like n^-3/2 for
// a shadow's edge, which crosses sqrt(n) cells, and like n^-1 for what the net does not see (footprint,
// alpha), without a rate to be assumed. A net does better than independent cells: kNet is the ratio of true
// to estimated deviation for shadow edges (the test has the scenes); for smooth weights the estimate is on
// the safe side. Not seen at all is a feature smaller than a cell that no sample met; the floor allows for a
// quarter of one.
#include "error_estimate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "direction_batch.h"
#include "relume/core/check.h"

namespace relume::transport {
namespace {

constexpr float kNet = 0.7f;
constexpr float kUnseen = 0.25f;  // cells

/// Every other bit of a Morton code.
std::uint32_t compact(std::uint32_t x) {
  x &= 0x5555u;
  x = (x | (x >> 1)) & 0x3333u;
  x = (x | (x >> 2)) & 0x0f0fu;
  return (x | (x >> 4)) & 0x00ffu;
}

}  // namespace

float netStandardError(std::span<const float> values, std::span<const std::uint16_t> codes,
                       std::span<float> scratch) {
  const auto n = static_cast<std::uint32_t>(values.size());
  RELUME_CHECK(std::has_single_bit(n) && scratch.size() >= n && codes.size() == n);
  float sum = 0.0f;
  std::uint32_t kept = 0;
  for (const float value : values) sum += std::max(value, 0.0f), kept += value >= 0.0f;
  const auto bits = static_cast<std::uint32_t>(std::countr_zero(n));
  const std::uint32_t width = 1u << ((bits + 1) / 2), height = 1u << (bits / 2);
  if (kept == 0 || height < 2) return 1.0f;
  const float mean = sum / static_cast<float>(kept);
  const std::uint32_t shift_x = 8 - (bits + 1) / 2, shift_y = 8 - bits / 2;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t x = compact(codes[i] >> 1u) >> shift_x, y = compact(codes[i]) >> shift_y;
    scratch[y * width + x] = values[i] < 0.0f ? 0.0f : values[i] - mean;
  }
  float squares = 0.0f;
  for (std::uint32_t y = 0; y + 1 < height; ++y) {
    const float *row = scratch.data() + y * width, *next = row + width;
    for (std::uint32_t x = 0; x + 1 < width; ++x) {
      const float d = row[x] - row[x + 1] - next[x] + next[x + 1];
      squares += d * d;
    }
  }
  const float blocks = static_cast<float>((width - 1) * (height - 1)), cells = static_cast<float>(n);
  const float variance = squares * 0.25f * cells / blocks;  // of the sum
  const float unseen = kUnseen / cells, k = static_cast<float>(kept);
  return std::sqrt(kNet * kNet * variance / (k * k) + unseen * unseen);
}

}  // namespace relume::transport
