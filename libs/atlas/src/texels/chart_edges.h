// SPDX-License-Identifier: MIT
// The borders of charts, as edges in space.
#pragma once
#include <cstdint>
#include <vector>

#include "relume/atlas/atlas.h"

namespace relume::atlas {

/// An edge of a chart's border; it runs from p0 to p1 along its triangle.
struct ChartEdge {
  Point p0, p1;              ///< world
  std::uint32_t uv = 0;      ///< index into Atlas::instances
  std::uint32_t corner = 0;  ///< 3 * triangle + k: from the triangle's vertex k to the next one
  float tolerance = 0;       ///< metres within which it is the same place as another edge

  float length() const { return glm::length(p1 - p0); }
};

/// Edges that exactly one triangle of its chart has, in atlas order; without those too short to be told from
/// a point.
std::vector<ChartEdge> chartEdges(const scene::Scene& scene, const Atlas& atlas);

/// Page position, in texels, at parameter t of the edge.
Vec2 pageAt(const Atlas& atlas, const ChartEdge& edge, float t);
/// Place on the surface at parameter t of the edge.
scene::Hit hitAt(const Atlas& atlas, const ChartEdge& edge, float t);

}  // namespace relume::atlas
