// SPDX-License-Identifier: MIT
// Rigid motions and segments of the plane.
#pragma once
#include <algorithm>
#include <limits>
#include <tuple>

#include "charts/overlap.h"

namespace relume::atlas {

/// p -> rotation * p + offset.
struct Motion {
  DVec2 turn{1, 0};  // cosine, sine
  DVec2 offset{0};
  DVec2 operator()(DVec2 p) const {
    return DVec2(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y) + offset;
  }
};

/// The rigid motion that lays segment (a, b) on segment (c, d), middle on middle.
inline Motion align(DVec2 a, DVec2 b, DVec2 c, DVec2 d) {
  const DVec2 from = b - a, to = d - c;
  DVec2 turn(glm::dot(from, to), from.x * to.y - from.y * to.x);
  const double length = glm::length(turn);
  turn = length > 0 ? turn / length : DVec2(1, 0);
  Motion motion{turn, DVec2(0)};
  motion.offset = 0.5 * (c + d) - motion(0.5 * (a + b));
  return motion;
}

/// Squared distance of two segments that do not cross, and where on each it is attained, in [0, 1].
inline std::tuple<double, double, double> closestPoints(const Segment& s, const Segment& t) {
  std::tuple<double, double, double> best{std::numeric_limits<double>::infinity(), 0, 0};
  const auto project = [](DVec2 p, const Segment& on) {
    const DVec2 d = on.b - on.a;
    const double length2 = glm::dot(d, d);
    return length2 > 0 ? std::clamp(glm::dot(p - on.a, d) / length2, 0.0, 1.0) : 0.0;
  };
  const auto consider = [&](double u, double v) {
    const DVec2 gap = s.a + u * (s.b - s.a) - t.a - v * (t.b - t.a);
    best = std::min(best, std::tuple(glm::dot(gap, gap), u, v));
  };
  consider(0, project(s.a, t));
  consider(1, project(s.b, t));
  consider(project(t.a, s), 0);
  consider(project(t.b, s), 1);
  return best;
}

}  // namespace relume::atlas
