// SPDX-License-Identifier: MIT
// Adds up a row of form factors.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "radiosity/form_factors.h"

namespace relume::transport {

class RowBuilder {
 public:
  explicit RowBuilder(std::size_t patches) : sum_(patches, 0.0) {}

  /// share > 0 in all but vanishing cases.
  void add(std::uint32_t patch, double share) {
    if (sum_[patch] == 0.0) touched_.push_back(patch);
    sum_[patch] += share;
  }
  /// The row so far, and begins anew.
  std::vector<FormFactors::Entry> take() {
    std::sort(touched_.begin(), touched_.end());
    std::vector<FormFactors::Entry> row;
    row.reserve(touched_.size());
    for (const std::uint32_t patch : touched_) {
      if (sum_[patch] > 0.0) row.push_back({patch, static_cast<float>(sum_[patch])});
      sum_[patch] = 0.0;
    }
    touched_.clear();
    return row;
  }

 private:
  std::vector<double> sum_;
  std::vector<std::uint32_t> touched_;
};

}  // namespace relume::transport
