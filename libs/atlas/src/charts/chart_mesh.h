// SPDX-License-Identifier: MIT
// A chart while it is made: its triangles, its own vertices and its map into the plane.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "charts/topology.h"

namespace relume::atlas {

using DVec2 = glm::dvec2;

/// A triangle laid flat: corners (0, 0), (x1, 0), (x2, y2), metres, counter-clockwise.
struct FlatTriangle {
  double x1, x2, y2;
  double area() const { return 0.5 * x1 * y2; }
};
FlatTriangle flatten(const Topology& topology, std::uint32_t triangle);

/// Vertices are fans of corners, so that sheets which touch in a point only may move apart. The map uv is in
/// metres and keeps the winding: every triangle turns counter-clockwise.
struct ChartMesh {
  std::vector<std::uint32_t> triangles;               ///< of the mesh
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< per triangle: vertices of the chart
  std::vector<DVec2> uv;                              ///< per vertex of the chart
  double area = 0;                                    ///< of the surface, m^2
  double mean_stretch = 1, max_stretch = 1;
  /// Half-edges 3 i + e of triangle i without a partner in the chart; the chart lies on their left.
  std::vector<std::uint32_t> border;

  std::uint32_t start(std::uint32_t h) const { return corners[h / 3][h % 3]; }
  std::uint32_t end(std::uint32_t h) const { return corners[h / 3][(h % 3 + 1) % 3]; }
  std::uint32_t opposite(std::uint32_t h) const { return corners[h / 3][(h % 3 + 2) % 3]; }
  std::uint32_t meshHalfEdge(std::uint32_t h) const { return 3 * triangles[h / 3] + h % 3; }
};

/// Joins the corners of `triangles` across all mates that lie in the chart too. uv is sized but zero.
class ChartMeshBuilder {
 public:
  explicit ChartMeshBuilder(const Topology& topology)
      : topology_(topology), local_(topology.triangleCount(), kNone) {}
  ChartMesh build(std::vector<std::uint32_t> triangles);

 private:
  const Topology& topology_;
  std::vector<std::uint32_t> local_;  // mesh triangle -> triangle of the chart being built
};

/// Stretch of the map uv -> surface ([SSGH01]): with singular values G >= g of a triangle's map, L2^2 is the
/// area-weighted mean of (G^2 + g^2) / 2 and Linf the largest G. The map is scaled first so that areas agree
/// in sum; an isometry then has 1.
struct Stretch {
  double surface = 0, plane = 0;  ///< areas, m^2
  double squares = 0;             ///< sum of area (G^2 + g^2) / 2
  double largest = 0;             ///< G
  bool valid = true;              ///< every triangle has positive area in the plane
};
Stretch measureStretch(const Topology& topology, const ChartMesh& chart);
/// Sets area, mean_stretch, max_stretch and scales uv. Returns false when the map is not valid.
bool normalizeAndMeasure(const Topology& topology, ChartMesh& chart);

}  // namespace relume::atlas
