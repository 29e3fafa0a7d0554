// SPDX-License-Identifier: MIT
// Smallest rectangles about points.
#pragma once
#include <vector>

#include "charts/chart_mesh.h"

namespace relume::atlas {

/// A rectangle whose longer side lies along the unit vector `axis`: coordinates along axis and across it, in
/// [lo, hi].
struct OrientedBox {
  DVec2 axis{1, 0};
  DVec2 lo{0}, hi{0};
  DVec2 extent() const { return hi - lo; }
  DVec2 toBox(DVec2 p) const { return {axis.x * p.x + axis.y * p.y, axis.x * p.y - axis.y * p.x}; }
};

/// The rectangle of least area about the points ([FS75]: one side lies along an edge of their convex hull).
OrientedBox smallestBox(std::vector<DVec2> points);

/// The smallest box about a chart's border.
OrientedBox boxOf(const ChartMesh& chart);

}  // namespace relume::atlas
