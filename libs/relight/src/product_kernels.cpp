// SPDX-License-Identifier: MIT
#include "product_kernels.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "product_kernels_x86.h"

namespace relume::relight {
namespace {

constexpr std::size_t kChannels = 3;

template <class Q>
void weighPlainly(const Q* weights, Weighing& w) {
  float lanes[kChannels][kTogether][kLanes] = {};
  for (std::size_t j = 0; j < w.columns; j += kLanes)
    for (std::size_t k = 0; k < w.count; ++k)
      for (std::size_t l = 0; l < kLanes; ++l) {
        const auto q = static_cast<float>(*weights++);
        const float weight = q * std::abs(q);
        for (std::size_t c = 0; c < kChannels; ++c)
          lanes[c][k][l] = std::fma(weight, w.x[c * w.stride + j + l], lanes[c][k][l]);
      }
  for (std::size_t c = 0; c < kChannels; ++c)
    for (std::size_t k = 0; k < w.count; ++k) {
      float s[kLanes / 2];
      for (std::size_t l = 0; l < kLanes / 2; ++l) s[l] = lanes[c][k][l] + lanes[c][k][l + kLanes / 2];
      w.sums[c][k] = ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
    }
}

template <std::size_t kPlaneChannels>
void addStripPlainly(StripPlanes& s, float (*rows)[kChannels]) {
  std::int32_t sums[kChannels][kStripRows] = {};
  std::fill(&rows[0][0], &rows[0][0] + kChannels * kStripRows, 0.0f);
  for (std::size_t r = 0; r < s.range_count; ++r) {
    for (std::size_t p = s.ranges[r].begin; p < s.ranges[r].end; ++p)
      for (std::size_t c = 0; c < kChannels; ++c) {
        const std::uint8_t* planes =
            s.planes + (p * kPlaneChannels + c % kPlaneChannels) * kStripRows * kQuad;
        const std::int16_t* factors = s.factors + (p * kChannels + c) * kQuad;
        for (std::size_t i = 0; i < kStripRows; ++i)
          for (std::size_t k = 0; k < kQuad; ++k)
            sums[c][i] += factors[k] * (static_cast<int>(planes[kQuad * i + k]) - kPlaneZero);
      }
    if (!closesGroup(s, r)) continue;
    for (std::size_t c = 0; c < kChannels; ++c)
      for (std::size_t i = 0; i < kStripRows; ++i) {
        rows[i][c] += stepOf(s, r, c) * static_cast<float>(sums[c][i]);
        sums[c][i] = 0;
      }
  }
}

void keepFactors(std::int16_t*, std::size_t) {}

}  // namespace

const ProductKernels& plainKernels() {
  static constexpr ProductKernels kPlain{weighPlainly<std::int8_t>, weighPlainly<std::int16_t>,
                                         addStripPlainly<3>, addStripPlainly<1>, keepFactors};
  return kPlain;
}

std::span<const ProductKernels* const> kernelsHere() {
  static const std::vector<const ProductKernels*> kHere = [] {
    std::vector<const ProductKernels*> here;
    for (const ProductKernels* kernels : {avx512Kernels(), avx2Kernels(), &plainKernels()})
      if (kernels) here.push_back(kernels);
    return here;
  }();
  return kHere;
}

}  // namespace relume::relight
