// SPDX-License-Identifier: MIT
// Which texel centres triangles claim.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/core/vec.h"

namespace relume::atlas {

/// How many triangles claim each texel's centre, up to 255. A centre on an edge or vertex that triangles
/// share belongs to one of them (top-left rule), so triangles that merely touch claim nothing twice.
class CentreCounter {
 public:
  CentreCounter(int width, int height)
      : width_(width),
        height_(height),
        counts_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0) {}
  void add(Vec2 a, Vec2 b, Vec2 c);
  std::uint64_t claimed() const;       ///< texels with at least one
  std::uint64_t claimedTwice() const;  ///< texels with two or more

 private:
  int width_, height_;
  std::vector<std::uint8_t> counts_;
};

}  // namespace relume::atlas
