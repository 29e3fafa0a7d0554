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
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "direction_batch.h"
#include "morton.h"
#include "relume/core/check.h"

namespace relume::transport {
namespace {

constexpr float kNet = 0.7f;
constexpr float kUnseen = 0.25f;  // cells

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
    const std::uint32_t x = compactBits(codes[i] >> 1u) >> shift_x, y = compactBits(codes[i]) >> shift_y;
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
  return standardErrorOf(squares * 0.25f * cells / blocks, kept, n);
}

void addNetVariances(std::span<const float> values, std::span<const float, 16> mean, std::span<float> scratch,
                     std::span<float, 16> variance) {
  constexpr std::size_t kColumns = 16;
  const auto n = static_cast<std::uint32_t>(values.size() / kColumns);
  RELUME_CHECK(std::has_single_bit(n) && scratch.size() >= values.size());
  const auto bits = static_cast<std::uint32_t>(std::countr_zero(n));
  const std::uint32_t width = 1u << ((bits + 1) / 2), height = 1u << (bits / 2);
  if (height < 2) {  // too few to tell: as if nothing were known
    for (float& v : variance) v += static_cast<float>(n * n);
    return;
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    scratch[i] = values[i] < 0.0f ? 0.0f : values[i] - mean[i % kColumns];
  // The lowest bit of a slot is of x where x has one more bit than y.
  const std::uint32_t shift_x = bits % 2 == 0 ? 1 : 0;
  const auto slot = [&](std::uint32_t x, std::uint32_t y) {
    return scratch.data() +
           static_cast<std::size_t>((spreadBits(x) << shift_x) | (spreadBits(y) << (1 - shift_x))) * kColumns;
  };
  std::array<float, kColumns> squares{};
  for (std::uint32_t y = 0; y + 1 < height; ++y) {
    for (std::uint32_t x = 0; x + 1 < width; ++x) {
      const float *r00 = slot(x, y), *r01 = slot(x + 1, y), *r10 = slot(x, y + 1), *r11 = slot(x + 1, y + 1);
      for (std::size_t c = 0; c < kColumns; ++c) {
        const float d = r00[c] - r01[c] - r10[c] + r11[c];
        squares[c] += d * d;
      }
    }
  }
  const float scale = 0.25f * static_cast<float>(n) / static_cast<float>((width - 1) * (height - 1));
  for (std::size_t c = 0; c < kColumns; ++c) variance[c] += squares[c] * scale;
}

float standardErrorOf(float variance, std::uint32_t kept, std::uint32_t n) {
  if (kept == 0) return 1.0f;
  const float unseen = kUnseen / static_cast<float>(n), k = static_cast<float>(kept);
  return std::min(1.0f, std::sqrt(kNet * kNet * variance / (k * k) + unseen * unseen));
}

float radianceStandardError(float variance, std::uint32_t n, float typical) {
  const float count = static_cast<float>(n), unseen = kUnseen * typical;
  return std::sqrt(kNet * kNet * variance + unseen * unseen) / count;
}

}  // namespace relume::transport
