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

/// Makes a solver for each worker and calls solve(solver, group, slots) for every group that holds a point of
/// `which` (none: all). slots[i]: the place of group[i] in `which`, or scene::kNone. Returns the rays that
/// the solvers say they traced. Throws Error kInterrupted; advances progress by one for every slot.
template <class Make, class Solve>
std::uint64_t solveGroups(const TexelGroups& groups, const atlas::Texels& texels,
                          std::span<const std::uint32_t> which, Progress& progress, const Make& make,
                          const Solve& solve) {
  const std::size_t points = texels.points.size();
  std::vector<std::uint32_t> slot_of;  // by point; only for a selection
  if (!which.empty()) slot_of.assign(points, scene::kNone);
  for (std::size_t i = 0; i < which.size(); ++i) {
    RELUME_CHECK_LT(which[i], points);
    slot_of[which[i]] = static_cast<std::uint32_t>(i);
  }
  const std::vector<std::size_t> tiles = groups.tilesOf(which);
  std::vector<std::uint64_t> rays(tiles.size(), 0);
  // Making a solver costs as much as some groups.
  std::mutex mutex;
  std::vector<decltype(make())> idle;
  parallelFor(tiles.size(), 4, [&](std::size_t begin, std::size_t end) {
    decltype(make()) solver;
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) solver = std::move(idle.back()), idle.pop_back();
    }
    if (!solver) solver = make();
    for (std::size_t tile = begin; tile < end; ++tile) {
      const std::uint64_t before = solver->rays();
      groups.forEachGroup(tiles[tile], [&](std::span<const std::uint32_t> group) {
        std::array<std::uint32_t, kGroupTexels> slots;
        std::transform(group.begin(), group.end(), slots.begin(),
                       [&](std::uint32_t i) { return slot_of.empty() ? i : slot_of[i]; });
        const auto used = std::span(slots).first(group.size());
        const auto skipped = std::count(used.begin(), used.end(), scene::kNone);
        if (skipped == std::ssize(used) || progress.cancelled()) return;
        const WorkItem item("texel", texels.points[group[0]].texel);
        solve(*solver, group, std::span<const std::uint32_t>(used));
        progress.advance(used.size() - static_cast<std::size_t>(skipped));
      });
      rays[tile] = solver->rays() - before;
    }
    const std::lock_guard lock(mutex);
    idle.push_back(std::move(solver));
  });
  progress.throwIfCancelled();
  std::uint64_t total = 0;
  for (const std::uint64_t r : rays) total += r;
  return total;
}

}  // namespace relume::transport
