// SPDX-License-Identifier: MIT
// Adds up a sparse row of RGB weights.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "relume/core/vec.h"

namespace relume::transport {

struct Weight {
  std::uint32_t index;
  Vec3 value;
};

class WeightSum {
 public:
  explicit WeightSum(std::size_t size) : sum_(size, Vec3(0.0f)), used_(size, 0) {}

  void add(std::uint32_t index, Vec3 value) {
    if (!used_[index]) used_[index] = 1, touched_.push_back(index);
    sum_[index] += value;
  }
  /// Appends the row so far by increasing index, and begins anew.
  void take(std::vector<Weight>& row) {
    std::sort(touched_.begin(), touched_.end());
    for (const std::uint32_t i : touched_) {
      row.push_back({i, sum_[i]});
      sum_[i] = Vec3(0.0f), used_[i] = 0;
    }
    touched_.clear();
  }

 private:
  std::vector<Vec3> sum_;
  std::vector<std::uint8_t> used_;
  std::vector<std::uint32_t> touched_;
};

}  // namespace relume::transport
