// SPDX-License-Identifier: MIT
// Finds the edges that pass through a point: a hash grid with a level of cells for each power of two of edge
// length.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "texels/chart_edges.h"

namespace relume::atlas {

class EdgeGrid {
 public:
  /// Keeps a reference to `edges`.
  explicit EdgeGrid(const std::vector<ChartEdge>& edges);

  /// Calls body(index) for edges of at least the length class of `edge` that may pass within their tolerance
  /// of one of its ends; in an order that depends on the edges alone. An edge may be named more than once. At
  /// most kMostCandidates a cell (real scenes have up to about 150), so that heaps of copies do not cost
  /// squares.
  template <class Body>
  void candidates(const ChartEdge& edge, const Body& body) const;

  static constexpr std::size_t kMostCandidates = 1024;

 private:
  struct Cell {
    int level;
    std::int64_t x, y, z;
  };
  static int levelOf(const ChartEdge& edge);
  static Cell cellAt(Point p, int level);
  static std::uint32_t hash(const Cell& cell);
  std::span<const std::uint64_t> entriesOf(std::uint32_t hash) const;

  std::vector<std::uint64_t> entries_;  // hash << 32 | edge, increasing
  std::vector<std::uint32_t> first_;    // by the upper bits of the hash
  int shift_ = 32;
  std::vector<int> levels_;  // in use, increasing
};

template <class Body>
void EdgeGrid::candidates(const ChartEdge& edge, const Body& body) const {
  const int own = levelOf(edge);
  for (const int level : levels_) {
    if (level < own) continue;
    const std::uint32_t at[2] = {hash(cellAt(edge.p0, level)), hash(cellAt(edge.p1, level))};
    for (int end = 0; end < (at[0] == at[1] ? 1 : 2); ++end) {
      const auto entries = entriesOf(at[end]);
      for (const std::uint64_t entry : entries.first(std::min(entries.size(), kMostCandidates))) {
        body(static_cast<std::uint32_t>(entry));
      }
    }
  }
}

}  // namespace relume::atlas
