// SPDX-License-Identifier: MIT
// Sutherland-Hodgman for axis-parallel lines.
#include "texels/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relume::atlas {

namespace {

template <int kAxis>
void splitAlong(const Polygon& polygon, double value, Polygon* below, Polygon* above) {
  if (below) below->count = 0;
  if (above) above->count = 0;
  if (polygon.count == 0) return;
  DVec2 p = polygon[polygon.count - 1];
  double dp = p[kAxis] - value;
  for (int i = 0; i < polygon.count; ++i) {
    const DVec2 q = polygon[i];
    const double dq = q[kAxis] - value;
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
      DVec2 cut = p + (q - p) * (dp / (dp - dq));
      cut[kAxis] = value;
      if (below) below->add(cut);
      if (above) above->add(cut);
    }
    if (below && dq <= 0) below->add(q);
    if (above && dq >= 0) above->add(q);
    p = q, dp = dq;
  }
}

}  // namespace

void splitAtX(const Polygon& polygon, double x, Polygon* below, Polygon* above) {
  splitAlong<0>(polygon, x, below, above);
}
void splitAtY(const Polygon& polygon, double y, Polygon* below, Polygon* above) {
  splitAlong<1>(polygon, y, below, above);
}

Polygon clipToTexel(const std::array<DVec2, 3>& triangle, int x, int y) {
  Polygon a, b;
  for (const DVec2 corner : triangle) a.add(corner);
  const DVec2 lo = glm::min(triangle[0], glm::min(triangle[1], triangle[2]));
  const DVec2 hi = glm::max(triangle[0], glm::max(triangle[1], triangle[2]));
  if (lo.x < x) splitAtX(a, x, nullptr, &b), a = b;
  if (hi.x > x + 1.0) splitAtX(a, x + 1.0, &b, nullptr), a = b;
  if (lo.y < y) splitAtY(a, y, nullptr, &b), a = b;
  if (hi.y > y + 1.0) splitAtY(a, y + 1.0, &b, nullptr), a = b;
  return a;
}

double area(const Polygon& polygon) {
  double twice = 0;
  for (int i = 2; i < polygon.count; ++i)
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * std::abs(twice);
}

DVec2 centroid(const Polygon& polygon) {
  double twice = 0;
  DVec2 moment(0), mean(0);
  for (int i = 0; i < polygon.count; ++i) {
    mean += polygon[i] - polygon[0];
    if (i < 2) continue;
    const DVec2 u = polygon[i - 1] - polygon[0], v = polygon[i] - polygon[0];
    const double part = cross(u, v);
    twice += part;
    moment += part * (u + v) / 3.0;
  }
  if (std::abs(twice) > 1e-14) return polygon[0] + moment / twice;
  return polygon[0] + mean / static_cast<double>(std::max(polygon.count, 1));
}

DVec2 nearestOnOutline(const Polygon& polygon, DVec2 p) {
  DVec2 best = polygon[0];
  double best_distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < polygon.count; ++i) {
    const DVec2 a = polygon[i], edge = polygon[i + 1 == polygon.count ? 0 : i + 1] - a;
    const double length = glm::dot(edge, edge);
    const double t = length > 0 ? std::clamp(glm::dot(p - a, edge) / length, 0.0, 1.0) : 0.0;
    const DVec2 q = a + t * edge, d = q - p;
    if (glm::dot(d, d) < best_distance) best_distance = glm::dot(d, d), best = q;
  }
  return best;
}

}  // namespace relume::atlas
