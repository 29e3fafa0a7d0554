// SPDX-License-Identifier: MIT
#include "product_kernels.h"

#include <cmath>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace relume::relight {
namespace {

constexpr std::size_t kChannels = 3;

template <class Q>
void weighPlainly(const Q* weights, const float* x, std::size_t stride, std::size_t columns, float* sums,
                  const std::int8_t*) {
  float lanes[kChannels][kTogether][kLanes] = {};
  for (std::size_t j = 0; j < columns; j += kLanes)
    for (std::size_t k = 0; k < kTogether; ++k)
      for (std::size_t l = 0; l < kLanes; ++l) {
        const auto q = static_cast<float>(*weights++);
        const float w = q * std::abs(q);
        for (std::size_t c = 0; c < kChannels; ++c) lanes[c][k][l] += w * x[c * stride + j + l];
      }
  for (std::size_t c = 0; c < kChannels; ++c)
    for (std::size_t k = 0; k < kTogether; ++k) {
      const float* s = lanes[c][k];
      sums[c * kTogether + k] = ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
    }
}

void addPairsPlainly(const std::int8_t* planes, const std::int16_t* factors, std::size_t pairs,
                     std::int32_t* sums) {
  for (std::size_t p = 0; p < pairs; ++p, planes += 2 * kStripRows, factors += 2)
    for (std::size_t i = 0; i < kStripRows; ++i)
      sums[i] += factors[0] * planes[2 * i] + factors[1] * planes[2 * i + 1];
}

#if defined(__x86_64__)
#define RELUME_AVX2 __attribute__((target("avx2")))

RELUME_AVX2 inline __m256i eight(const std::int8_t* q) {
  return _mm256_cvtepi8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q)));
}
RELUME_AVX2 inline __m256i eight(const std::int16_t* q) {
  return _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(q)));
}

template <class Q>
RELUME_AVX2 void weighAvx2(const Q* weights, const float* x, std::size_t stride, std::size_t columns,
                           float* sums, const std::int8_t* ahead) {
  __m256 lanes[kChannels][kTogether];
  for (auto& channel : lanes)
    for (__m256& lane : channel) lane = _mm256_setzero_ps();
  const __m256 sign = _mm256_set1_ps(-0.0f);
  for (std::size_t j = 0; j < columns; j += kLanes) {
    _mm_prefetch(reinterpret_cast<const char*>(ahead) + j * 64 / kLanes, _MM_HINT_T1);
    const __m256 red = _mm256_loadu_ps(x + j), green = _mm256_loadu_ps(x + stride + j),
                 blue = _mm256_loadu_ps(x + 2 * stride + j);
    for (std::size_t k = 0; k < kTogether; ++k, weights += kLanes) {
      const __m256 q = _mm256_cvtepi32_ps(eight(weights));
      const __m256 w = _mm256_mul_ps(q, _mm256_andnot_ps(sign, q));
      lanes[0][k] = _mm256_add_ps(lanes[0][k], _mm256_mul_ps(w, red));
      lanes[1][k] = _mm256_add_ps(lanes[1][k], _mm256_mul_ps(w, green));
      lanes[2][k] = _mm256_add_ps(lanes[2][k], _mm256_mul_ps(w, blue));
    }
  }
  static_assert(kTogether == 4 && kLanes == 8);
  for (std::size_t c = 0; c < kChannels; ++c) {
    const __m256 halves =
        _mm256_hadd_ps(_mm256_hadd_ps(lanes[c][0], lanes[c][1]), _mm256_hadd_ps(lanes[c][2], lanes[c][3]));
    _mm_storeu_ps(sums + c * kTogether,
                  _mm_add_ps(_mm256_castps256_ps128(halves), _mm256_extractf128_ps(halves, 1)));
  }
}

RELUME_AVX2 inline __m256i sixteen(const std::int8_t* q) {
  return _mm256_cvtepi8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(q)));
}

RELUME_AVX2 void addPairsAvx2(const std::int8_t* planes, const std::int16_t* factors, std::size_t pairs,
                              std::int32_t* sums) {
  auto* out = reinterpret_cast<__m256i*>(sums);
  __m256i low = _mm256_loadu_si256(out), high = _mm256_loadu_si256(out + 1);
  for (std::size_t p = 0; p < pairs; ++p, planes += 2 * kStripRows, factors += 2) {
    std::int32_t bits;
    std::memcpy(&bits, factors, sizeof bits);
    const __m256i both = _mm256_set1_epi32(bits);
    low = _mm256_add_epi32(low, _mm256_madd_epi16(both, sixteen(planes)));
    high = _mm256_add_epi32(high, _mm256_madd_epi16(both, sixteen(planes + kStripRows)));
  }
  _mm256_storeu_si256(out, low);
  _mm256_storeu_si256(out + 1, high);
}
#endif

}  // namespace

const ProductKernels& plainKernels() {
  static constexpr ProductKernels kPlain{weighPlainly<std::int8_t>, weighPlainly<std::int16_t>,
                                         addPairsPlainly};
  return kPlain;
}

const ProductKernels& bestKernels() {
#if defined(__x86_64__)
  static constexpr ProductKernels kAvx2{weighAvx2<std::int8_t>, weighAvx2<std::int16_t>, addPairsAvx2};
  static const bool has_avx2 = __builtin_cpu_supports("avx2");
  if (has_avx2) return kAvx2;
#endif
  return plainKernels();
}

}  // namespace relume::relight
