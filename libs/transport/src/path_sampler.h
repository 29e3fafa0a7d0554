// SPDX-License-Identifier: MIT
// The random numbers of one path: pairs of Owen-scrambled Sobol dimensions, each pair its own scramble
// ("padding"), a function of (seed, item, run, index, pair).
#pragma once
#include <cstdint>

#include "relume/core/sampling.h"

namespace relume::transport {

class PathSampler {
 public:
  /// Paths of one run form a sequence; runs are independent.
  PathSampler(std::uint64_t seed, std::uint32_t item, std::uint32_t run, std::uint32_t index)
      : stream_(streamOf(seed, item, run)), index_(index) {}

  Vec2 pair() { return sobol2(index_, hashCombine(stream_, ++dimension_)); }
  std::uint32_t bits() { return hashCombine(hashCombine(stream_, ++dimension_), index_); }

 private:
  std::uint32_t stream_, index_, dimension_ = 0;
};

}  // namespace relume::transport
