// SPDX-License-Identifier: MIT
#pragma once
#if defined(__SSE2__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace relume::trace {

/// Flushes denormals to zero while it lives, as Embree recommends and as every query of the tracer does for
/// itself; around many queries it saves them the change of mode, some percent of a packet.
class FlushDenormals {
 public:
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
#if defined(__SSE2__)
  FlushDenormals() : saved_(_mm_getcsr()) {
    if ((saved_ & kFlush) != kFlush) _mm_setcsr(saved_ | kFlush);
  }
  ~FlushDenormals() {
    if ((saved_ & kFlush) != kFlush) _mm_setcsr(saved_);
  }

 private:
  static constexpr unsigned int kFlush = _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON;
  unsigned int saved_;
#else
  FlushDenormals() {}
#endif
};

}  // namespace relume::trace
