// SPDX-License-Identifier: MIT
#include "relume/core/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "relume/core/frame.h"

namespace relume {
namespace {

using Flat = glm::dvec2;

/// Twice the area of a triangle, positive when counter-clockwise.
double turn(Flat a, Flat b, Flat c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

bool within(Flat p, Flat a, Flat b, Flat c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

/// p, which is in line with a and b, lies between them.
bool between(Flat p, Flat a, Flat b) { return glm::dot(p - a, p - b) <= 0; }

bool meet(Flat a, Flat b, Flat c, Flat d) {
  const double ta = turn(c, d, a), tb = turn(c, d, b), tc = turn(a, b, c), td = turn(a, b, d);
  if (((ta > 0 && tb < 0) || (ta < 0 && tb > 0)) && ((tc > 0 && td < 0) || (tc < 0 && td > 0))) return true;
  return (ta == 0 && between(a, c, d)) || (tb == 0 && between(b, c, d)) || (tc == 0 && between(c, a, b)) ||
         (td == 0 && between(d, a, b));
}

bool meetsItself(const std::vector<Flat>& corners) {
  const std::size_t n = corners.size();
  const auto at = [&](std::size_t i) { return corners[i % n]; };
  for (std::size_t i = 0; i < n; ++i) {
    if (at(i) == at(i + 1)) return true;
    // The next edge runs back over this one.
    if (turn(at(i), at(i + 1), at(i + 2)) == 0 && glm::dot(at(i + 1) - at(i), at(i + 2) - at(i + 1)) < 0)
      return true;
    for (std::size_t j = i + 2; j < n && j + 1 < i + n; ++j)
      if (meet(at(i), at(i + 1), at(j), at(j + 1))) return true;
  }
  return false;
}

}  // namespace

glm::dvec3 areaVector(std::span<const Point> corners) {
  glm::dvec3 sum(0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const glm::dvec3 origin(corners[0]);
    sum += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[i + 1]) - origin);
  }
  return 0.5 * sum;
}

std::vector<std::array<Point, 3>> triangulate(std::span<const Point> corners) {
  const glm::dvec3 area = areaVector(corners);
  const double size = glm::length(area);
  if (!(size > 0)) return {};
  const Frame frame = Frame::about(Normal(area / size));
  std::vector<Flat> flat;
  for (const Point p : corners) {
    const glm::dvec3 d = glm::dvec3(p) - glm::dvec3(corners[0]);
    flat.emplace_back(glm::dot(d, glm::dvec3(frame.t)), glm::dot(d, glm::dvec3(frame.b)));
  }
  if (meetsItself(flat)) return {};

  std::vector<std::array<Point, 3>> triangles;
  std::vector<std::size_t> left(corners.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  const double flat_enough = 1e-12 * size;
  std::size_t k = 0, since_cut = 0;
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    if (since_cut++ > n) return {};  // rounding has made an outline of no ears
    k %= n;
    const std::size_t a = left[(k + n - 1) % n], b = left[k], c = left[(k + 1) % n];
    const double ear = turn(flat[a], flat[b], flat[c]);
    const auto hinders = [&](std::size_t i) {
      return i != a && i != b && i != c && within(flat[i], flat[a], flat[b], flat[c]);
    };
    const bool straight = std::abs(ear) <= flat_enough;
    if (!straight && (ear < 0 || std::any_of(left.begin(), left.end(), hinders))) {
      ++k;
      continue;
    }
    if (!straight) triangles.push_back({corners[a], corners[b], corners[c]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
    since_cut = 0;
  }
  return triangles;
}

}  // namespace relume
