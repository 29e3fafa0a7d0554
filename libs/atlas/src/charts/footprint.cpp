// SPDX-License-Identifier: MIT
// A square overlaps a convex triangle exactly when the part of the triangle in the square's row overlaps the
// square's columns, so each row needs one interval per triangle.
#include "charts/footprint.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace relume::atlas {

void BitGrid::setRun(int y, int begin, int end) {
  std::uint64_t* words = row(y);
  const int first = begin >> 6, last = (end - 1) >> 6;
  const std::uint64_t head = ~std::uint64_t{0} << (begin & 63);
  const std::uint64_t tail = ~std::uint64_t{0} >> (63 - ((end - 1) & 63));
  if (first == last) {
    words[first] |= head & tail;
    return;
  }
  words[first] |= head;
  for (int w = first + 1; w < last; ++w) words[w] = ~std::uint64_t{0};
  words[last] |= tail;
}

std::size_t BitGrid::count() const {
  std::size_t sum = 0;
  for (const std::uint64_t word : bits_) sum += static_cast<std::size_t>(std::popcount(word));
  return sum;
}

void coverTriangle(BitGrid& grid, Vec2 a, Vec2 b, Vec2 c, float margin) {
  const Vec2 corner[3] = {a, b, c};
  const float y_lo = std::min({a.y, b.y, c.y}), y_hi = std::max({a.y, b.y, c.y});
  const int first_row = std::max(0, static_cast<int>(std::floor(y_lo - margin)));
  const int last_row = std::min(grid.height(), static_cast<int>(std::ceil(y_hi + margin))) - 1;
  for (int y = first_row; y <= last_row; ++y) {
    const float lo = static_cast<float>(y) - margin, hi = static_cast<float>(y + 1) + margin;
    float x_lo = kInfinity, x_hi = -kInfinity;
    for (int k = 0; k < 3; ++k) {
      Vec2 p = corner[k], q = corner[(k + 1) % 3];
      if (p.y > q.y) std::swap(p, q);
      if (q.y < lo || p.y > hi) continue;
      const float slope = q.y > p.y ? (q.x - p.x) / (q.y - p.y) : 0.0f;
      const float xp = p.y < lo ? p.x + slope * (lo - p.y) : p.x;
      const float xq = q.y > hi ? p.x + slope * (hi - p.y) : q.x;
      x_lo = std::min({x_lo, xp, xq});
      x_hi = std::max({x_hi, xp, xq});
    }
    const int begin = std::max(0, static_cast<int>(std::floor(x_lo - margin)));
    const int end = std::min(grid.width(), static_cast<int>(std::ceil(x_hi + margin)));
    if (begin < end) grid.setRun(y, begin, end);
  }
}

Footprint footprintOf(const BitGrid& grid) {
  Footprint footprint{grid.width(), grid.height(), {}, 0};
  for (int y = 0; y < grid.height(); ++y) {
    const std::uint64_t* words = grid.row(y);
    int begin = -1;
    for (int w = 0; w < grid.words(); ++w) {
      std::uint64_t word = words[w];
      int x = 64 * w;
      const int end = x + 64;
      while (x < end) {
        const std::uint64_t rest = word >> (x - 64 * w);
        if (begin < 0) {
          if (rest == 0) break;
          x += std::countr_zero(rest);
          begin = x;
        } else {
          const int ones = std::countr_one(rest);
          x += ones;
          if (x < end) {
            footprint.runs.push_back({y, begin, x - begin});
            begin = -1;
          }
        }
      }
    }
    if (begin >= 0) footprint.runs.push_back({y, begin, grid.width() - begin});
  }
  for (const Run& run : footprint.runs) footprint.texels += static_cast<std::size_t>(run.length);
  return footprint;
}

BitGrid quarterTurn(const BitGrid& grid) {
  BitGrid turned(grid.height(), grid.width());
  for (int y = 0; y < grid.height(); ++y) {
    for (int w = 0; w < grid.words(); ++w) {
      for (std::uint64_t word = grid.row(y)[w]; word != 0; word &= word - 1) {
        turned.set(grid.height() - 1 - y, 64 * w + std::countr_zero(word));
      }
    }
  }
  return turned;
}

}  // namespace relume::atlas
