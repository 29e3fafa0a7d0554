// SPDX-License-Identifier: MIT
// Rows of floats that the compiler keeps in registers while it adds many others to them.
#pragma once
#include <cstddef>
#include <cstring>

namespace relume::transport {

/// N floats, a multiple of 8. Sums are formed element by element, so their bits are the same whatever the
/// width of the machine's registers.
template <std::size_t N>
class VectorRow {
 public:
  static_assert(N % 8 == 0);

  void clear() { std::memset(v_, 0, sizeof v_); }
  /// += factor * from[0 .. N)
  void add(float factor, const float* from) {
    for (std::size_t i = 0; i < N / 8; ++i) v_[i] += factor * load(from + 8 * i);
  }
  void store(float* to) const { std::memcpy(to, v_, sizeof v_); }

 private:
  using Lanes [[gnu::vector_size(32)]] = float;
  static Lanes load(const float* from) {
    Lanes lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
  }
  Lanes v_[N / 8];
};

}  // namespace relume::transport
