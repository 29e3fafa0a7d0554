// SPDX-License-Identifier: MIT
// The texels that triangles cover, conservatively, as runs of bits.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/core/vec.h"

namespace relume::atlas {

/// Rows of 64-bit words; bit x of row y is texel (x, y).
class BitGrid {
 public:
  BitGrid() = default;
  BitGrid(int width, int height)
      : width_(width),
        height_(height),
        words_((width + 63) / 64),
        bits_(static_cast<std::size_t>(words_) * height) {}
  int width() const { return width_; }
  int height() const { return height_; }
  bool get(int x, int y) const { return row(y)[x >> 6] >> (x & 63) & 1; }
  void set(int x, int y) { row(y)[x >> 6] |= std::uint64_t{1} << (x & 63); }
  void setRun(int y, int begin, int end);
  std::size_t count() const;
  std::uint64_t* row(int y) { return bits_.data() + static_cast<std::size_t>(y) * words_; }
  const std::uint64_t* row(int y) const { return bits_.data() + static_cast<std::size_t>(y) * words_; }
  int words() const { return words_; }
  void clear() { bits_.assign(bits_.size(), 0); }

 private:
  int width_ = 0, height_ = 0, words_ = 0;
  std::vector<std::uint64_t> bits_;
};

/// Sets the texels whose squares overlap the triangle grown by `margin` along the axes; exact otherwise.
/// Clipped to the grid.
void coverTriangle(BitGrid& grid, Vec2 a, Vec2 b, Vec2 c, float margin = 0.0f);

struct Run {
  std::int32_t row, begin, length;
};

struct Footprint {
  int width = 0, height = 0;
  std::vector<Run> runs;  ///< by row, then begin
  std::size_t texels = 0;
};
Footprint footprintOf(const BitGrid& grid);
/// Turned by a quarter: texel (x, y) goes to (height - 1 - y, x).
BitGrid quarterTurn(const BitGrid& grid);

}  // namespace relume::atlas
