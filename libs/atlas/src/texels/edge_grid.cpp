// SPDX-License-Identifier: MIT
// If two collinear edges overlap, an end of the shorter lies on the longer. So each edge is entered into the
// cells it passes through at the level of its own length (a few, since a cell is longer than the edge), and
// asks for its two ends at its own and all coarser levels.
#include "texels/edge_grid.h"

#include <bit>
#include <cmath>

#include "relume/core/sampling.h"

namespace relume::atlas {
namespace {

/// Whether the segment comes within `margin` of the box (a slab test: may say yes to a little more).
bool meets(const ChartEdge& edge, glm::dvec3 lo, glm::dvec3 hi, double margin) {
  const glm::dvec3 origin(edge.p0), along = glm::dvec3(edge.p1) - origin;
  double t0 = 0, t1 = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double below = lo[axis] - margin - origin[axis], above = hi[axis] + margin - origin[axis];
    if (along[axis] == 0) {
      if (below > 0 || above < 0) return false;
      continue;
    }
    const double a = below / along[axis], b = above / along[axis];
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  return t0 <= t1;
}

}  // namespace

int EdgeGrid::levelOf(const ChartEdge& edge) {
  int exponent = 0;
  std::frexp(edge.length(), &exponent);
  return exponent;  // 2^exponent is above the length, at most twice as much
}

EdgeGrid::Cell EdgeGrid::cellAt(Point p, int level) {
  const double size = std::ldexp(1.0, level);
  const auto index = [size](float x) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(x) / size));
  };
  return {level, index(p.x), index(p.y), index(p.z)};
}

std::uint32_t EdgeGrid::hash(const Cell& cell) {
  const auto word = [](std::int64_t i) { return static_cast<std::uint32_t>(i); };
  return hashCombine(hashCombine(hashCombine(word(cell.level), word(cell.x)), word(cell.y)), word(cell.z));
}

EdgeGrid::EdgeGrid(const std::vector<ChartEdge>& edges) {
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    const ChartEdge& edge = edges[i];
    const int level = levelOf(edge);
    if (std::find(levels_.begin(), levels_.end(), level) == levels_.end()) levels_.push_back(level);
    const double size = std::ldexp(1.0, level);
    const Vec3 margin(edge.tolerance);
    const Cell lo = cellAt(glm::min(edge.p0, edge.p1) - margin, level);
    const Cell hi = cellAt(glm::max(edge.p0, edge.p1) + margin, level);
    for (std::int64_t z = lo.z; z <= hi.z; ++z) {
      for (std::int64_t y = lo.y; y <= hi.y; ++y) {
        for (std::int64_t x = lo.x; x <= hi.x; ++x) {
          const glm::dvec3 corner = glm::dvec3(x, y, z) * size;
          if (!meets(edge, corner, corner + size, static_cast<double>(edge.tolerance))) continue;
          entries_.push_back(std::uint64_t{hash({level, x, y, z})} << 32 | i);
        }
      }
    }
  }
  std::sort(levels_.begin(), levels_.end());
  std::sort(entries_.begin(), entries_.end());
  entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
  // About one entry for each value of the upper bits.
  const int bits = std::clamp(static_cast<int>(std::bit_width(entries_.size())), 1, 28);
  shift_ = 32 - bits;
  first_.assign((std::size_t{1} << bits) + 1, 0);
  for (const std::uint64_t entry : entries_) ++first_[(entry >> 32 >> shift_) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

std::span<const std::uint64_t> EdgeGrid::entriesOf(std::uint32_t hash) const {
  const std::size_t slot = hash >> shift_;
  const auto begin = entries_.begin() + first_[slot], end = entries_.begin() + first_[slot + 1];
  const auto from =
      std::find_if(begin, end, [&](std::uint64_t e) { return static_cast<std::uint32_t>(e >> 32) >= hash; });
  auto to = from;
  while (to != end && static_cast<std::uint32_t>(*to >> 32) == hash) ++to;
  return {from, to};
}

}  // namespace relume::atlas
