// SPDX-License-Identifier: MIT
#include "product_kernels_x86.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include <cstring>

#define RELUME_AVX2 __attribute__((target("avx2,fma")))

namespace relume::relight {
namespace {

constexpr std::size_t kChannels = 3, kHalf = 8 /* lanes of a register */, kSome = 4;  // components

RELUME_AVX2 inline __m256i eight(const std::int8_t* q) {
  return _mm256_cvtepi8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q)));
}
RELUME_AVX2 inline __m256i eight(const std::int16_t* q) {
  return _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(q)));
}

struct HalfSums {
  __m256 of[kChannels][kSome];
};

// Half of the lanes of some components, for want of registers.
template <std::size_t kCount, class Q>
RELUME_AVX2 inline HalfSums weighHalf(const Q* weights, Weighing& w, std::size_t half) {
  HalfSums lanes;
  for (auto& channel : lanes.of)
    for (__m256& lane : channel) lane = _mm256_setzero_ps();
  const __m256 sign = _mm256_set1_ps(-0.0f);
  const float *red = w.x + half, *green = red + w.stride, *blue = green + w.stride;
  const std::size_t columns = w.columns, step = w.count * kLanes;
  Ahead ahead = w.ahead;
  weights += half;
  for (std::size_t j = 0; j < columns; j += kLanes, weights += step) {
    const __m256 x[kChannels] = {_mm256_loadu_ps(red + j), _mm256_loadu_ps(green + j),
                                 _mm256_loadu_ps(blue + j)};
    fetch<sizeof(Q)>(ahead);
    for (std::size_t k = 0; k < kCount; ++k) {
      const __m256 q = _mm256_cvtepi32_ps(eight(weights + k * kLanes));
      const __m256 weight = _mm256_mul_ps(q, _mm256_andnot_ps(sign, q));
      for (std::size_t c = 0; c < kChannels; ++c)
        lanes.of[c][k] = _mm256_fmadd_ps(weight, x[c], lanes.of[c][k]);
    }
  }
  w.ahead = ahead;
  return lanes;
}

template <std::size_t kCount, class Q>
RELUME_AVX2 void weighSome(const Q* weights, Weighing& w, std::size_t first) {
  static_assert(kSome == 4 && kTogether % kSome == 0 && kLanes == 2 * kHalf);
  const HalfSums low = weighHalf<kCount>(weights + first * kLanes, w, 0);
  const HalfSums high = weighHalf<kCount>(weights + first * kLanes, w, kHalf);
  for (std::size_t c = 0; c < kChannels; ++c) {
    __m256 sums[kSome];
    for (std::size_t k = 0; k < kSome; ++k) sums[k] = _mm256_add_ps(low.of[c][k], high.of[c][k]);
    const __m256 halves = _mm256_hadd_ps(_mm256_hadd_ps(sums[0], sums[1]), _mm256_hadd_ps(sums[2], sums[3]));
    _mm_storeu_ps(w.sums[c] + first,
                  _mm_add_ps(_mm256_castps256_ps128(halves), _mm256_extractf128_ps(halves, 1)));
  }
}

template <class Q>
RELUME_AVX2 void weighAvx2(const Q* weights, Weighing& w) {
  for (std::size_t first = 0; first < w.count; first += kSome) switch (w.count - first) {
      case 1:
        weighSome<1>(weights, w, first);
        break;
      case 2:
        weighSome<2>(weights, w, first);
        break;
      case 3:
        weighSome<3>(weights, w, first);
        break;
      default:
        weighSome<4>(weights, w, first);
    }
}

// Four rows of a quad of planes.
RELUME_AVX2 inline __m256i sixteen(const std::uint8_t* q) {
  return _mm256_cvtepu8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(q)));
}

RELUME_AVX2 inline __m256i quadOf(const std::int16_t* factors) {
  std::int64_t all;
  std::memcpy(&all, factors, sizeof all);
  return _mm256_set1_epi64x(all);
}

// Sums of the halves of a quad, four rows in each of two, become those of eight rows.
RELUME_AVX2 inline __m256i rowSums(__m256i first, __m256i second) {
  return _mm256_permute4x64_epi64(_mm256_hadd_epi32(first, second), 0xd8);
}

// Eight rows; each but the last is written over by the next from its fourth number on.
RELUME_AVX2 inline void storeRows(const __m256* channels, float (*rows)[kChannels]) {
  const __m256 zero = _mm256_setzero_ps();
  const __m256 rg[2] = {_mm256_unpacklo_ps(channels[0], channels[1]),
                        _mm256_unpackhi_ps(channels[0], channels[1])};
  const __m256 b[2] = {_mm256_unpacklo_ps(channels[2], zero), _mm256_unpackhi_ps(channels[2], zero)};
  __m256 even[2], odd[2];
  for (std::size_t i = 0; i < 2; ++i)
    even[i] = _mm256_shuffle_ps(rg[i], b[i], 0x44), odd[i] = _mm256_shuffle_ps(rg[i], b[i], 0xee);
  for (std::size_t i = 0; i < 2; ++i) {
    _mm_storeu_ps(rows[2 * i], _mm256_castps256_ps128(even[i]));
    _mm_storeu_ps(rows[2 * i + 1], _mm256_castps256_ps128(odd[i]));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    _mm_storeu_ps(rows[2 * i + 4], _mm256_extractf128_ps(even[i], 1));
    _mm_storeu_ps(rows[2 * i + 5], _mm256_extractf128_ps(odd[i], 1));
  }
}

template <std::size_t kPlaneChannels>
RELUME_AVX2 void addStripAvx2(StripPlanes& s, float (*rows)[kChannels]) {
  constexpr std::size_t kQuarters = 4, kBytes = kStripRows * kQuad, kStep = kPlaneChannels == 1 ? 0 : kBytes;
  __m256 low[kChannels], high[kChannels];
  __m256i sums[kChannels][kQuarters];
  for (std::size_t c = 0; c < kChannels; ++c) {
    low[c] = high[c] = _mm256_setzero_ps();
    for (__m256i& sum : sums[c]) sum = _mm256_setzero_si256();
  }
  for (std::size_t r = 0; r < s.range_count; ++r) {
    const QuadRange range = s.ranges[r];
    const std::uint8_t* planes = s.planes + range.begin * kPlaneChannels * kBytes;
    const std::int16_t* factors = s.factors + range.begin * kChannels * kQuad;
    for (std::size_t p = range.begin; p < range.end; ++p, planes += kPlaneChannels * kBytes) {
      fetch<2>(s.ahead);
      for (std::size_t c = 0; c < kChannels; ++c, factors += kQuad) {
        const __m256i quad = quadOf(factors);
        for (std::size_t i = 0; i < kQuarters; ++i)
          sums[c][i] = _mm256_add_epi32(
              sums[c][i], _mm256_madd_epi16(quad, sixteen(planes + c * kStep + i * kBytes / kQuarters)));
      }
    }
    if (!closesGroup(s, r)) continue;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const __m256 step = _mm256_set1_ps(stepOf(s, r, c));
      const __m256i start = _mm256_set1_epi32(startOf(s, r, c));
      const auto add = [&](__m256& to, __m256i sum) RELUME_AVX2 {
        to = _mm256_add_ps(to, _mm256_mul_ps(step, _mm256_cvtepi32_ps(_mm256_add_epi32(sum, start))));
      };
      add(low[c], rowSums(sums[c][0], sums[c][1]));
      add(high[c], rowSums(sums[c][2], sums[c][3]));
      for (__m256i& sum : sums[c]) sum = _mm256_setzero_si256();
    }
  }
  storeRows(low, rows);
  storeRows(high, rows + kHalf);
}

void keepFactors(std::int16_t*, std::size_t) {}

}  // namespace

const ProductKernels* avx2Kernels() {
  static constexpr ProductKernels kAvx2{weighAvx2<std::int8_t>, weighAvx2<std::int16_t>, addStripAvx2<3>,
                                        addStripAvx2<1>, keepFactors};
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? &kAvx2 : nullptr;
}

}  // namespace relume::relight

#else

namespace relume::relight {
const ProductKernels* avx2Kernels() { return nullptr; }
}  // namespace relume::relight

#endif
