// SPDX-License-Identifier: MIT
// Based on:
//   [FS75] Freeman, Shapira. Determining the Minimum-Area Encasing Rectangle for an Arbitrary Closed Curve.
//   1975.
#include "charts/box.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace relume::atlas {
namespace {

double cross(DVec2 a, DVec2 b) { return a.x * b.y - a.y * b.x; }

// Andrew's monotone chain; the first point is repeated at the end.
std::vector<DVec2> convexHull(std::vector<DVec2> points) {
  std::sort(points.begin(), points.end(),
            [](DVec2 a, DVec2 b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  std::vector<DVec2> hull(2 * points.size() + 1);
  std::size_t k = 0;
  const auto add = [&](DVec2 p, std::size_t least) {
    while (k >= least && cross(hull[k - 1] - hull[k - 2], p - hull[k - 2]) <= 0) --k;
    hull[k++] = p;
  };
  for (const DVec2 p : points) add(p, 2);
  const std::size_t upper = k + 1;
  for (std::size_t i = points.size(); i-- > 1;) add(points[i - 1], upper);
  hull.resize(k);
  return hull;
}

}  // namespace

OrientedBox smallestBox(std::vector<DVec2> points) {
  const std::vector<DVec2> hull = convexHull(std::move(points));
  OrientedBox best;
  double best_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const DVec2 e = hull[(i + 1) % hull.size()] - hull[i];
    const double length = glm::length(e);
    OrientedBox box;
    if (length > 0) {
      box.axis = e / length;
    } else if (i > 0) {
      continue;
    }
    box.lo = DVec2(std::numeric_limits<double>::infinity());
    box.hi = -box.lo;
    for (const DVec2 p : hull) {
      box.lo = glm::min(box.lo, box.toBox(p));
      box.hi = glm::max(box.hi, box.toBox(p));
    }
    const DVec2 extent = box.extent();
    if (extent.x * extent.y >= best_area * (1 - 1e-9)) continue;
    best_area = extent.x * extent.y;
    if (extent.x < extent.y) {
      box = {DVec2(-box.axis.y, box.axis.x), DVec2(box.lo.y, -box.hi.x), DVec2(box.hi.y, -box.lo.x)};
    }
    best = box;
  }
  return best;
}

OrientedBox boxOf(const ChartMesh& chart) {
  std::vector<DVec2> points;
  points.reserve(chart.border.size());
  for (const std::uint32_t h : chart.border) points.push_back(chart.uv[chart.start(h)]);
  return smallestBox(points.empty() ? chart.uv : std::move(points));
}

}  // namespace relume::atlas
