// SPDX-License-Identifier: MIT
#include "charts/centre_counter.h"

#include <algorithm>
#include <cmath>

namespace relume::atlas {

void CentreCounter::add(Vec2 a, Vec2 b, Vec2 c) {
  const auto cross = [](glm::dvec2 p, glm::dvec2 q) { return p.x * q.y - p.y * q.x; };
  glm::dvec2 corner[3] = {a, b, c};
  const double area = cross(corner[1] - corner[0], corner[2] - corner[0]);
  if (area == 0) return;
  if (area < 0) std::swap(corner[1], corner[2]);
  const auto range = [](double lo, double hi, int size) {
    return std::pair(std::max(0, static_cast<int>(std::ceil(lo - 0.5))),
                     std::min(size - 1, static_cast<int>(std::floor(hi - 0.5))));
  };
  const auto [x_first, x_last] = range(std::min({corner[0].x, corner[1].x, corner[2].x}),
                                       std::max({corner[0].x, corner[1].x, corner[2].x}), width_);
  const auto [y_first, y_last] = range(std::min({corner[0].y, corner[1].y, corner[2].y}),
                                       std::max({corner[0].y, corner[1].y, corner[2].y}), height_);
  for (int y = y_first; y <= y_last; ++y) {
    for (int x = x_first; x <= x_last; ++x) {
      const glm::dvec2 p(x + 0.5, y + 0.5);
      bool inside = true;
      for (int k = 0; k < 3 && inside; ++k) {
        // The same end first whichever triangle asks, so that both round alike.
        glm::dvec2 from = corner[k], to = corner[(k + 1) % 3];
        const bool forward = from.x < to.x || (from.x == to.x && from.y < to.y);
        if (!forward) std::swap(from, to);
        double height = cross(to - from, p - from);
        if (!forward) height = -height;
        inside = height > 0 || (height == 0 && forward);
      }
      if (!inside) continue;
      std::uint8_t& count = counts_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                    static_cast<std::size_t>(x)];
      count = static_cast<std::uint8_t>(std::min(255, count + 1));
    }
  }
}

std::uint64_t CentreCounter::claimed() const {
  return static_cast<std::uint64_t>(
      std::count_if(counts_.begin(), counts_.end(), [](std::uint8_t n) { return n > 0; }));
}

std::uint64_t CentreCounter::claimedTwice() const {
  return static_cast<std::uint64_t>(
      std::count_if(counts_.begin(), counts_.end(), [](std::uint8_t n) { return n > 1; }));
}

}  // namespace relume::atlas
