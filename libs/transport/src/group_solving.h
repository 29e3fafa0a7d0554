// SPDX-License-Identifier: MIT
// The loop that solvers of texels share: group by group, in parallel, for all points or a selection.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "relume/core/check.h"
#include "relume/core/parallel.h"
#include "relume/core/progress.h"
#include "texel_groups.h"

namespace relume::transport {

/// How many times smaller smoothing makes the error of a texel that shares its block with so many of its
/// chart: as the root of what the window holds, but for what differences of value and normal leave out.
inline float smoothingGain(std::size_t texels) {
  return std::max(1.0f, std::sqrt(static_cast<float>(texels)) / 1.5f);
}

/// Where the result of a point goes: its place in a selection.
class Slots {
 public:
  Slots(std::span<const std::uint32_t> which, std::size_t points)
      : count_(which.empty() ? points : which.size()) {
    for (const std::uint32_t i : which) RELUME_CHECK_LT(i, points);
    if (which.empty()) return;
    first_ = which[0];
    // Nearly always a run of points, which needs no table.
    const auto apart = [](std::uint32_t a, std::uint32_t b) { return b != a + 1; };
    if (std::adjacent_find(which.begin(), which.end(), apart) == which.end()) return;
    table_.assign(points, scene::kNone);
    for (std::size_t i = 0; i < which.size(); ++i) table_[which[i]] = static_cast<std::uint32_t>(i);
  }

  std::uint32_t operator()(std::uint32_t point) const {
    if (!table_.empty()) return table_[point];
    return point >= first_ && point - first_ < count_ ? point - first_ : scene::kNone;
  }

 private:
  std::size_t count_;
  std::uint32_t first_ = 0;
  std::vector<std::uint32_t> table_;
};

/// Solvers that no thread is using: making one costs as much as some groups.
template <class Solver>
class SolverPool {
 public:
  template <class Make>
  std::unique_ptr<Solver> take(const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        auto solver = std::move(idle_.back());
        idle_.pop_back();
        return solver;
      }
    }
    return make();
  }
  void giveBack(std::unique_ptr<Solver> solver) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(solver));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Solver>> idle_;
};

/// Calls solve(solver, group, slots) for every group that holds a point of `which` (none: all), with a solver
/// of the pool or one that `make` makes. slots[i]: the place of group[i] in `which`, or scene::kNone. Returns
/// the rays that the solvers say they traced. Throws Error kInterrupted; advances progress by one for every
/// slot.
template <class Solver, class Make, class Solve>
std::uint64_t solveGroups(const TexelGroups& groups, const atlas::Texels& texels,
                          std::span<const std::uint32_t> which, Progress& progress, SolverPool<Solver>& pool,
                          const Make& make, const Solve& solve) {
  const std::size_t points = texels.points.size();
  const Slots slots_of(which, points);
  const std::vector<std::size_t> tiles =
      groups.tilesOf(which.size() == points ? std::span<const std::uint32_t>() : which);
  std::vector<std::uint64_t> rays(tiles.size(), 0);
  parallelFor(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<Solver> solver = pool.take(make);
    for (std::size_t tile = begin; tile < end; ++tile) {
      const std::uint64_t before = solver->rays();
      groups.forEachGroup(tiles[tile], [&](std::span<const std::uint32_t> group) {
        std::array<std::uint32_t, kGroupTexels> slots;
        std::transform(group.begin(), group.end(), slots.begin(), slots_of);
        const auto used = std::span(slots).first(group.size());
        const auto skipped = std::count(used.begin(), used.end(), scene::kNone);
        if (skipped == std::ssize(used) || progress.cancelled()) return;
        const WorkItem item("texel", texels.points[group[0]].texel);
        solve(*solver, group, std::span<const std::uint32_t>(used));
        progress.advance(used.size() - static_cast<std::size_t>(skipped));
      });
      rays[tile] = solver->rays() - before;
    }
    pool.giveBack(std::move(solver));
  });
  progress.throwIfCancelled();
  std::uint64_t total = 0;
  for (const std::uint64_t r : rays) total += r;
  return total;
}

}  // namespace relume::transport
