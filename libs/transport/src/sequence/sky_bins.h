// SPDX-License-Identifier: MIT
// Directions in bins of equal solid angle, by height and azimuth.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "relume/core/parallel.h"
#include "relume/scene/environment.h"

namespace relume::transport {

class SkyBins {
 public:
  static constexpr std::uint32_t kRows = 64, kColumns = 128, kCount = kRows * kColumns;

  static std::uint32_t of(Direction d) {
    const float around = std::atan2(d.z, d.x) * (0.5f * kInvPi) + 0.5f;
    const auto row = static_cast<std::uint32_t>(std::clamp((d.y + 1) * (0.5f * kRows), 0.0f, kRows - 1.0f));
    const auto column = static_cast<std::uint32_t>(std::clamp(around * kColumns, 0.0f, kColumns - 1.0f));
    return row * kColumns + column;
  }

  /// Mean radiance of each bin, from 3 x 3 places.
  static std::vector<Vec3> radiance(const scene::Environment& environment) {
    constexpr int kPlaces = 3;
    std::vector<Vec3> bins(kCount, Vec3(0.0f));
    if (environment.dark()) return bins;
    parallelFor(kCount, kColumns, [&](std::size_t begin, std::size_t end) {
      for (std::size_t bin = begin; bin < end; ++bin)
        for (int k = 0; k < kPlaces * kPlaces; ++k) {
          const float u = (static_cast<float>(k % kPlaces) + 0.5f) / kPlaces,
                      v = (static_cast<float>(k / kPlaces) + 0.5f) / kPlaces;
          const float angle = 2 * kPi * ((static_cast<float>(bin % kColumns) + u) / kColumns - 0.5f);
          const float y = 2 * (static_cast<float>(bin / kColumns) + v) / kRows - 1;
          const float r = std::sqrt(std::max(1 - y * y, 0.0f));
          bins[bin] += environment.from({r * std::cos(angle), y, r * std::sin(angle)}).rgb /
                       static_cast<float>(kPlaces * kPlaces);
        }
    });
    return bins;
  }
};

}  // namespace relume::transport
