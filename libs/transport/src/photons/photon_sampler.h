// SPDX-License-Identifier: MIT
// The random numbers of paths from lights: low-discrepancy points over all paths where a path begins and for
// its first bounces, hashes from then on, when chance is as good. A function of (seed, path, place in it).
#pragma once
#include <array>
#include <cstdint>

#include "relume/core/sampling.h"

namespace relume::transport {

class PhotonSampler {
 public:
  explicit PhotonSampler(std::uint64_t seed)
      : hash_(streamOf(seed, 0, kRun)),
        nets_{Sobol2(stream(1)), Sobol2(stream(2)), Sobol2(stream(3)), Sobol2(stream(4)), Sobol2(stream(5))} {
  }

  void begin(std::uint64_t path) {
    index_ = static_cast<std::uint32_t>(path);
    // Beyond 2^32 paths nets begin again, and are shuffled by what is hashed.
    state_ = hashCombine(hash_, index_ ^ hashCombine(static_cast<std::uint32_t>(path >> 32), kRun));
    pairs_ = 0, numbers_ = 0;
  }
  Vec2 pair() {
    if (pairs_ < nets_.size()) return nets_[pairs_++](index_);
    const float first = number();
    return {first, number()};
  }
  std::uint32_t bits() { return hashCombine(state_, ++numbers_); }
  /// In [0, 1).
  float number() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }

 private:
  static constexpr std::uint32_t kRun = 0x70686f74u;  // sets these numbers apart
  std::uint32_t stream(std::uint32_t k) const { return hashCombine(hash_, k); }

  std::uint32_t hash_;
  std::array<Sobol2, 5> nets_;  // choice, place, direction, and two bounces
  std::uint32_t index_ = 0, state_ = 0, numbers_ = 0;
  std::size_t pairs_ = 0;
};

}  // namespace relume::transport
