// SPDX-License-Identifier: MIT
// What the versions of the inner loops for x86 processors share.
#pragma once
#include "product_kernels.h"

namespace relume::relight {

/// Null where this processor, or any of its kind, cannot run them.
const ProductKernels* avx2Kernels();
const ProductKernels* avx512Kernels();  ///< with VNNI: four products of 8 bits to an addition

/// Whether range r is the last of its group.
inline bool closesGroup(const StripPlanes& s, std::size_t r) {
  return r + 1 == s.range_count || s.ranges[r + 1].begin / kGroupQuads != s.ranges[r].begin / kGroupQuads;
}
inline float stepOf(const StripPlanes& s, std::size_t r, std::size_t channel) {
  return s.steps[s.ranges[r].begin / kGroupQuads * 3 + channel];
}
inline std::int32_t startOf(const StripPlanes& s, std::size_t r, std::size_t channel) {
  return s.starts[s.ranges[r].begin / kGroupQuads * 3 + channel];
}

/// Fetches the next lines into the second cache.
template <std::size_t kLines>
inline void fetch(Ahead& ahead) {
  constexpr std::size_t kLine = 64;
  if (ahead.next >= ahead.end) return;
  for (std::size_t i = 0; i < kLines; ++i) __builtin_prefetch(ahead.next + i * kLine, 0, 2);
  ahead.next += kLines * kLine;
}

}  // namespace relume::relight
