// SPDX-License-Identifier: MIT
#include "product_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

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
      const float* s = lanes[c][k];
      w.sums[c][k] = ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
    }
}

/// Whether range r is the last of its group.
bool closesGroup(const StripPlanes& s, std::size_t r) {
  return r + 1 == s.range_count || s.ranges[r + 1].begin / kGroupPairs != s.ranges[r].begin / kGroupPairs;
}
const float* stepsOf(const StripPlanes& s, std::size_t r) {
  return s.steps + s.ranges[r].begin / kGroupPairs * kChannels;
}

template <std::size_t kPlaneChannels>
void addStripPlainly(const StripPlanes& s, float (*rows)[4]) {
  std::int32_t sums[kChannels][kStripRows] = {};
  std::fill(&rows[0][0], &rows[0][0] + 4 * kStripRows, 0.0f);
  for (std::size_t r = 0; r < s.range_count; ++r) {
    for (std::size_t p = s.ranges[r].begin; p < s.ranges[r].end; ++p)
      for (std::size_t c = 0; c < kChannels; ++c) {
        const std::int8_t* planes = s.planes + (p * kPlaneChannels + c % kPlaneChannels) * 2 * kStripRows;
        const std::int16_t* factors = s.factors + (p * kChannels + c) * 2;
        for (std::size_t i = 0; i < kStripRows; ++i)
          sums[c][i] += factors[0] * planes[2 * i] + factors[1] * planes[2 * i + 1];
      }
    if (!closesGroup(s, r)) continue;
    for (std::size_t c = 0; c < kChannels; ++c)
      for (std::size_t i = 0; i < kStripRows; ++i) {
        rows[i][c] += stepsOf(s, r)[c] * static_cast<float>(sums[c][i]);
        sums[c][i] = 0;
      }
  }
}

#if defined(__x86_64__)
#define RELUME_AVX2 __attribute__((target("avx2,fma")))

RELUME_AVX2 inline __m256i eight(const std::int8_t* q) {
  return _mm256_cvtepi8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q)));
}
RELUME_AVX2 inline __m256i eight(const std::int16_t* q) {
  return _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(q)));
}

template <std::size_t kCount, class Q>
RELUME_AVX2 void weighSome(const Q* weights, Weighing& w) {
  __m256 lanes[kChannels][kTogether];
  for (auto& channel : lanes)
    for (__m256& lane : channel) lane = _mm256_setzero_ps();
  const __m256 sign = _mm256_set1_ps(-0.0f);
  const float *red = w.x, *green = red + w.stride, *blue = green + w.stride;
  for (std::size_t j = 0; j < w.columns; j += kLanes) {
    const __m256 x[kChannels] = {_mm256_loadu_ps(red + j), _mm256_loadu_ps(green + j),
                                 _mm256_loadu_ps(blue + j)};
    for (std::size_t k = 0; k < kCount; ++k, weights += kLanes) {
      const __m256 q = _mm256_cvtepi32_ps(eight(weights));
      const __m256 weight = _mm256_mul_ps(q, _mm256_andnot_ps(sign, q));
      for (std::size_t c = 0; c < kChannels; ++c) lanes[c][k] = _mm256_fmadd_ps(weight, x[c], lanes[c][k]);
    }
  }
  static_assert(kTogether == 4 && kLanes == 8);
  for (std::size_t c = 0; c < kChannels; ++c) {
    const __m256 halves =
        _mm256_hadd_ps(_mm256_hadd_ps(lanes[c][0], lanes[c][1]), _mm256_hadd_ps(lanes[c][2], lanes[c][3]));
    _mm_storeu_ps(w.sums[c], _mm_add_ps(_mm256_castps256_ps128(halves), _mm256_extractf128_ps(halves, 1)));
  }
}

template <class Q>
RELUME_AVX2 void weighAvx2(const Q* weights, Weighing& w) {
  switch (w.count) {
    case 4:
      return weighSome<4>(weights, w);
    case 3:
      return weighSome<3>(weights, w);
    case 2:
      return weighSome<2>(weights, w);
    default:
      return weighSome<1>(weights, w);
  }
}

RELUME_AVX2 inline __m256i sixteen(const std::int8_t* q) {
  return _mm256_cvtepi8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(q)));
}

RELUME_AVX2 inline __m256i twoFactors(const std::int16_t* factors) {
  std::int32_t both;
  std::memcpy(&both, factors, sizeof both);
  return _mm256_set1_epi32(both);
}

// Eight rows of three channels become rows of four.
RELUME_AVX2 inline void storeRows(const __m256* channels, float (*rows)[4]) {
  const __m256 zero = _mm256_setzero_ps();
  const __m256 rg[2] = {_mm256_unpacklo_ps(channels[0], channels[1]),
                        _mm256_unpackhi_ps(channels[0], channels[1])};
  const __m256 b[2] = {_mm256_unpacklo_ps(channels[2], zero), _mm256_unpackhi_ps(channels[2], zero)};
  for (std::size_t i = 0; i < 2; ++i) {
    const __m256 even = _mm256_shuffle_ps(rg[i], b[i], 0x44), odd = _mm256_shuffle_ps(rg[i], b[i], 0xee);
    _mm_storeu_ps(rows[2 * i], _mm256_castps256_ps128(even));
    _mm_storeu_ps(rows[2 * i + 1], _mm256_castps256_ps128(odd));
    _mm_storeu_ps(rows[2 * i + 4], _mm256_extractf128_ps(even, 1));
    _mm_storeu_ps(rows[2 * i + 5], _mm256_extractf128_ps(odd, 1));
  }
}

template <std::size_t kPlaneChannels>
RELUME_AVX2 void addStripAvx2(const StripPlanes& s, float (*rows)[4]) {
  constexpr std::size_t kStep = kPlaneChannels == 1 ? 0 : 2 * kStripRows;
  __m256 low[kChannels], high[kChannels];
  __m256i low_sums[kChannels], high_sums[kChannels];
  for (std::size_t c = 0; c < kChannels; ++c) {
    low[c] = high[c] = _mm256_setzero_ps();
    low_sums[c] = high_sums[c] = _mm256_setzero_si256();
  }
  for (std::size_t r = 0; r < s.range_count; ++r) {
    const PairRange range = s.ranges[r];
    const std::int8_t* planes = s.planes + range.begin * kPlaneChannels * 2 * kStripRows;
    const std::int16_t* factors = s.factors + range.begin * kChannels * 2;
    for (std::size_t p = range.begin; p < range.end; ++p, planes += kPlaneChannels * 2 * kStripRows)
      for (std::size_t c = 0; c < kChannels; ++c, factors += 2) {
        const __m256i both = twoFactors(factors);
        low_sums[c] = _mm256_add_epi32(low_sums[c], _mm256_madd_epi16(both, sixteen(planes + c * kStep)));
        high_sums[c] =
            _mm256_add_epi32(high_sums[c], _mm256_madd_epi16(both, sixteen(planes + c * kStep + kStripRows)));
      }
    if (!closesGroup(s, r)) continue;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const __m256 step = _mm256_set1_ps(stepsOf(s, r)[c]);
      low[c] = _mm256_add_ps(low[c], _mm256_mul_ps(step, _mm256_cvtepi32_ps(low_sums[c])));
      high[c] = _mm256_add_ps(high[c], _mm256_mul_ps(step, _mm256_cvtepi32_ps(high_sums[c])));
      low_sums[c] = high_sums[c] = _mm256_setzero_si256();
    }
  }
  storeRows(low, rows);
  storeRows(high, rows + kLanes);
}
#endif

}  // namespace

const ProductKernels& plainKernels() {
  static constexpr ProductKernels kPlain{weighPlainly<std::int8_t>, weighPlainly<std::int16_t>,
                                         addStripPlainly<3>, addStripPlainly<1>};
  return kPlain;
}

const ProductKernels& bestKernels() {
#if defined(__x86_64__)
  static constexpr ProductKernels kAvx2{weighAvx2<std::int8_t>, weighAvx2<std::int16_t>, addStripAvx2<3>,
                                        addStripAvx2<1>};
  static const bool can = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (can) return kAvx2;
#endif
  return plainKernels();
}

}  // namespace relume::relight
