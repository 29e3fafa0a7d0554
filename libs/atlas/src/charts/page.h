// SPDX-License-Identifier: MIT
// A page being filled: where does a footprint fit?
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "charts/footprint.h"

namespace relume::atlas {

/// A footprint made ready for search.
struct Shape {
  Footprint footprint;
  std::vector<Run> probes;         ///< the runs, those that decide most first
  int square = 0, square_row = 0;  ///< side and top row of the largest square inside
  std::uint64_t hash = 0;          ///< of the runs
};
Shape prepareShape(Footprint footprint);

/// Occupied cells of a page. Bits of level k tell whether one of the 2^k cells from there to the right is
/// occupied, so a run of any length is tried at 64 positions with a few word operations.
class Occupancy {
 public:
  Occupancy(int width, int height);

  /// The first free place by rows, top down, then from the left, that does not reach below `last_row`.
  /// `hasty`: looks only near where a footprint of about the same size was found last.
  std::optional<IVec2> find(const Shape& shape, int last_row, bool hasty = false);
  void occupyRun(int y, int begin, int end);
  /// Occupies the cells of rows [first, last] and columns [begin, end) in which `finer`, of half the cell
  /// size, has any.
  void takeFrom(const Occupancy& finer, int first, int last, int begin, int end);
  /// To be called for all rows that changed, before the next search.
  void refresh(int y, int begin, int end);

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  static constexpr int kLevels = 7;
  std::uint64_t* row(int level, int y) {
    return levels_[static_cast<std::size_t>(level)].data() +
           static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_);
  }
  const std::uint64_t* row(int level, int y) const {
    return levels_[static_cast<std::size_t>(level)].data() +
           static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_);
  }
  std::uint64_t fetch(int level, int y, int x) const;
  std::uint64_t runBlocked(int y, int x, int length) const;
  std::uint64_t blocked(const Shape& shape, int x, int y) const;
  int firstSquareRow(int side);

  int width_, height_, stride_;
  std::array<std::vector<std::uint64_t>, kLevels> levels_;
  std::vector<std::int32_t> longest_free_;  // per row
  std::vector<std::int32_t> square_row_;    // per side: no such free square starts above this row
  std::unordered_map<std::uint64_t, std::int32_t> shape_row_;  // by hash: nor does such a shape
  std::unordered_map<std::uint32_t, std::int32_t> size_row_;   // by class of size: where the last was found
};

/// A page with gutters. On coarser grids large footprints lose a percent or two of the page, and the search
/// is much shorter.
class Page {
 public:
  enum class Search {
    kEverywhere,
    kCoarse,  ///< large footprints on coarser grids
    kHasty,   ///< so, and not again where footprints of about the same size found no place
  };
  Page(int width, int height, int gutter, Search search);

  struct Place {
    IVec2 corner{0};
    int turns = 0;   ///< quarter turns
    int bottom = 0;  ///< the row below the footprint
  };
  /// The place, over the turns (four, in haste two), whose bottom is highest; nothing where the footprint
  /// does not fit.
  std::optional<Place> find(const Footprint& footprint);
  /// Occupies a footprint and the gutter about it.
  void occupy(const Footprint& footprint, const Place& place);

 private:
  int width_, height_, gutter_;
  bool hasty_;
  std::vector<Occupancy> layers_;  // cells of 1, 2, 4, 8 texels
};

}  // namespace relume::atlas
