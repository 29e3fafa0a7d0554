// SPDX-License-Identifier: MIT
// Factors are taken as two digits of 8 bits, f = 256 high + low, which multiply samples of 8 bits as they
// are: nothing is widened.
#include "product_kernels_x86.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include <cstring>

#define RELUME_AVX512 __attribute__((target("avx512f,avx512bw,avx512vnni,avx2,fma")))

namespace relume::relight {
namespace {

constexpr std::size_t kChannels = 3;

// q |q| of sixteen weights. Of 8 bits it is a whole number of 16, which spares the units that add and
// multiply floats: they have most to do.
RELUME_AVX512 inline __m512 weightsOf(const std::int8_t* weights) {
  const __m256i q = _mm256_cvtepi8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(weights)));
  return _mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(_mm256_mullo_epi16(q, _mm256_abs_epi16(q))));
}
RELUME_AVX512 inline __m512 weightsOf(const std::int16_t* weights) {
  const __m512 q = _mm512_cvtepi32_ps(
      _mm512_cvtepi16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(weights))));
  return _mm512_mul_ps(q, _mm512_abs_ps(q));
}

RELUME_AVX512 inline __m256 folded(__m512 lanes) {
  const __m512d all = _mm512_castps_pd(lanes);
  const __m256 low = _mm256_castpd_ps(_mm512_maskz_extractf64x4_pd(0xf, all, 0));
  const __m256 high = _mm256_castpd_ps(_mm512_maskz_extractf64x4_pd(0xf, all, 1));
  return _mm256_add_ps(low, high);
}

template <std::size_t kCount, class Q>
RELUME_AVX512 void weighSome(const Q* weights, Weighing& w) {
  constexpr std::size_t kFours = (kCount + 3) / 4;
  __m512 lanes[kChannels][4 * kFours];
  for (auto& channel : lanes)
    for (__m512& lane : channel) lane = _mm512_setzero_ps();
  const float *red = w.x, *green = red + w.stride, *blue = green + w.stride;
  Ahead ahead = w.ahead;
  for (std::size_t j = 0; j < w.columns; j += kLanes) {
    const __m512 x[kChannels] = {_mm512_loadu_ps(red + j), _mm512_loadu_ps(green + j),
                                 _mm512_loadu_ps(blue + j)};
    fetch<(kCount + 1) / 2 * sizeof(Q)>(ahead);
    for (std::size_t k = 0; k < kCount; ++k, weights += kLanes) {
      const __m512 weight = weightsOf(weights);
      for (std::size_t c = 0; c < kChannels; ++c) lanes[c][k] = _mm512_fmadd_ps(weight, x[c], lanes[c][k]);
    }
  }
  w.ahead = ahead;
  static_assert(kTogether == 8 && kLanes == 16);
  for (std::size_t c = 0; c < kChannels; ++c)
    for (std::size_t k = 0; k < 4 * kFours; k += 4) {
      const __m512* four = lanes[c] + k;
      const __m256 halves = _mm256_hadd_ps(_mm256_hadd_ps(folded(four[0]), folded(four[1])),
                                           _mm256_hadd_ps(folded(four[2]), folded(four[3])));
      _mm_storeu_ps(w.sums[c] + k,
                    _mm_add_ps(_mm256_castps256_ps128(halves), _mm256_extractf128_ps(halves, 1)));
    }
}

template <class Q>
RELUME_AVX512 void weighAvx512(const Q* weights, Weighing& w) {
  using Weigh = void (*)(const Q*, Weighing&);
  static constexpr Weigh kOf[kTogether] = {weighSome<1, Q>, weighSome<2, Q>, weighSome<3, Q>,
                                           weighSome<4, Q>, weighSome<5, Q>, weighSome<6, Q>,
                                           weighSome<7, Q>, weighSome<8, Q>};
  kOf[w.count - 1](weights, w);
}

RELUME_AVX512 inline __m512i digitsOf(const std::int8_t* digits) {
  std::int32_t quad;
  std::memcpy(&quad, digits, sizeof quad);
  return _mm512_set1_epi32(quad);
}

// Sixteen rows of three channels, one after the other.
RELUME_AVX512 inline void storeRows(const __m512* channels, float (*rows)[kChannels]) {
  const auto store = [&](std::size_t third, __m512i red_green, __mmask16 is_blue, __m512i blue)
                         RELUME_AVX512 {
                           const __m512 both = _mm512_permutex2var_ps(channels[0], red_green, channels[1]);
                           _mm512_storeu_ps(&rows[0][0] + third * kStripRows,
                                            _mm512_mask_permutexvar_ps(both, is_blue, blue, channels[2]));
                         };
  // Places of green are those of red plus 16.
  store(0, _mm512_setr_epi32(0, 16, 0, 1, 17, 0, 2, 18, 0, 3, 19, 0, 4, 20, 0, 5), 0x4924,
        _mm512_setr_epi32(0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0));
  store(1, _mm512_setr_epi32(21, 0, 6, 22, 0, 7, 23, 0, 8, 24, 0, 9, 25, 0, 10, 26), 0x2492,
        _mm512_setr_epi32(0, 5, 0, 0, 6, 0, 0, 7, 0, 0, 8, 0, 0, 9, 0, 0));
  store(2, _mm512_setr_epi32(0, 11, 27, 0, 12, 28, 0, 13, 29, 0, 14, 30, 0, 15, 31, 0), 0x9249,
        _mm512_setr_epi32(10, 0, 0, 11, 0, 0, 12, 0, 0, 13, 0, 0, 14, 0, 0, 15));
}

template <std::size_t kPlaneChannels>
RELUME_AVX512 void addStripAvx512(StripPlanes& s, float (*rows)[kChannels]) {
  constexpr std::size_t kBytes = kStripRows * kQuad, kStep = kPlaneChannels == 1 ? 0 : kBytes;
  __m512 total[kChannels];
  __m512i low[kChannels], high[kChannels];
  for (std::size_t c = 0; c < kChannels; ++c) {
    total[c] = _mm512_setzero_ps();
    low[c] = high[c] = _mm512_setzero_si512();
  }
  Ahead ahead = s.ahead;
  for (std::size_t r = 0; r < s.range_count; ++r) {
    const QuadRange range = s.ranges[r];
    const std::uint8_t* planes = s.planes + range.begin * kPlaneChannels * kBytes;
    const auto* digits = reinterpret_cast<const std::int8_t*>(s.factors + range.begin * kChannels * kQuad);
    for (std::size_t p = range.begin; p < range.end; ++p, planes += kPlaneChannels * kBytes) {
      fetch<2>(ahead);
      for (std::size_t c = 0; c < kChannels; ++c, digits += 2 * kQuad) {
        const __m512i q = _mm512_loadu_si512(planes + c * kStep);
        low[c] = _mm512_dpbusd_epi32(low[c], q, digitsOf(digits));
        high[c] = _mm512_dpbusd_epi32(high[c], q, digitsOf(digits + kQuad));
      }
    }
    if (!closesGroup(s, r)) continue;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const __m512i start = _mm512_set1_epi32(startOf(s, r, c));
      const __m512i sum = _mm512_add_epi32(_mm512_add_epi32(low[c], start), _mm512_slli_epi32(high[c], 8));
      total[c] =
          _mm512_add_ps(total[c], _mm512_mul_ps(_mm512_set1_ps(stepOf(s, r, c)), _mm512_cvtepi32_ps(sum)));
      low[c] = high[c] = _mm512_setzero_si512();
    }
  }
  s.ahead = ahead;
  storeRows(total, rows);
}

// Four low digits, then four high ones: f = 256 high + low with both in [-128, 127].
RELUME_AVX512 void partFactors(std::int16_t* factors, std::size_t quads) {
  const __m128i order = _mm_setr_epi8(0, 2, 4, 6, 1, 3, 5, 7, 8, 10, 12, 14, 9, 11, 13, 15);
  const __m128i low_bits = _mm_set1_epi16(0x00ff), half = _mm_set1_epi16(128);
  const auto part = [&](__m128i f) RELUME_AVX512 {
    const __m128i high = _mm_andnot_si128(low_bits, _mm_add_epi16(f, half));
    return _mm_shuffle_epi8(_mm_or_si128(_mm_and_si128(f, low_bits), high), order);
  };
  std::size_t i = 0;
  for (; i + 2 <= quads; i += 2, factors += 2 * kQuad)
    _mm_storeu_si128(reinterpret_cast<__m128i*>(factors),
                     part(_mm_loadu_si128(reinterpret_cast<const __m128i*>(factors))));
  if (i < quads)
    _mm_storel_epi64(reinterpret_cast<__m128i*>(factors),
                     part(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(factors))));
}

}  // namespace

const ProductKernels* avx512Kernels() {
  static constexpr ProductKernels kAvx512{weighAvx512<std::int8_t>, weighAvx512<std::int16_t>,
                                          addStripAvx512<3>, addStripAvx512<1>, partFactors};
  const bool can = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                   __builtin_cpu_supports("avx512vnni") && __builtin_cpu_supports("fma");
  return can ? &kAvx512 : nullptr;
}

}  // namespace relume::relight

#else

namespace relume::relight {
const ProductKernels* avx512Kernels() { return nullptr; }
}  // namespace relume::relight

#endif
