// SPDX-License-Identifier: MIT
// Entry points shot from where lights may be, and how densely they lie. Based on:
//   [USKP09] Umenhoffer et al. Multi-scale precomputed radiance transfer. Section 7.1.
// From each of M test points Y_m go N rays of density p_m; where they end are entries. At a place e that
// faces along n their density, a number for each square metre, is
//   d(e) = N sum_m p_m(Y_m -> e) cos+(n, e -> Y_m) / |Y_m - e|^2 v(Y_m, e),
// so that the sum of f(e) / d(e) over entries has the integral of f over what test points see as its mean.
// Limits: visibility is that of one shadow ray from each test point, which decides by chance where surfaces
// are cut out by alpha.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relume/core/progress.h"
#include "relume/trace/tracer.h"

namespace relume::transport {

struct ShotRays {
  std::vector<Point> from;       ///< Y_m
  std::uint32_t each = 1;        ///< N
  std::optional<Direction> aim;  ///< p = cos+ / pi about it; none: 1 / (4 pi), all around

  /// p, 1 / sr
  float density(Direction way) const;
  Direction direction(Vec2 u) const;
};

struct ShotEntry {
  scene::Hit where;
  Point from{0};  ///< the test point
  Point position{0};
  Normal normal{0, 0, 1};  ///< geometric, on the side that the ray came to
  float density = 0;       ///< d, 1 / m^2; above 0
};

/// d at a place. seen_from: the index of a test point that is known to see it.
float entryDensity(const trace::Tracer& tracer, const ShotRays& rays, Point position, Normal normal,
                   std::optional<std::size_t> seen_from = {});

/// Where all rays end that meet a surface, by test point and ray. Throws Error kInterrupted.
std::vector<ShotEntry> shootEntries(const trace::Tracer& tracer, const ShotRays& rays, std::uint64_t seed,
                                    Progress& progress);

/// The N with which about `count` rays meet something, from a few rays of each test point; at least 1.
std::uint32_t raysForEntries(const trace::Tracer& tracer, const ShotRays& rays, std::size_t count,
                             std::uint64_t seed);

}  // namespace relume::transport
