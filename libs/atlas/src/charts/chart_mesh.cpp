// SPDX-License-Identifier: MIT
// Stretch as in
//   [SSGH01] Sander, Snyder, Gortler, Hoppe. Texture Mapping Progressive Meshes. 2001. Section 3.
#include "charts/chart_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace relume::atlas {

FlatTriangle flatten(const Topology& topology, std::uint32_t triangle) {
  const UVec3 c = topology.triangles[triangle];
  const glm::dvec3 a(topology.position[c[0]]), b(topology.position[c[1]]), d(topology.position[c[2]]);
  const glm::dvec3 e1 = b - a, e2 = d - a;
  const double x1 = glm::length(e1);
  return {x1, glm::dot(e1, e2) / x1, glm::length(glm::cross(e1, e2)) / x1};
}

ChartMesh ChartMeshBuilder::build(std::vector<std::uint32_t> triangles) {
  ChartMesh chart;
  chart.triangles = std::move(triangles);
  chart.triangles.shrink_to_fit();
  const auto count = static_cast<std::uint32_t>(chart.triangles.size());
  for (std::uint32_t i = 0; i < count; ++i) local_[chart.triangles[i]] = i;

  std::vector<std::uint32_t> parent(3 * count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&](std::uint32_t c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent[std::max(a, b)] = std::min(a, b);
  };
  const auto localMate = [&](std::uint32_t h) {  // half-edge of the chart, kNone on the border
    const std::uint32_t mate = topology_.mate[3 * chart.triangles[h / 3] + h % 3];
    return mate == kNone || local_[mate / 3] == kNone ? kNone : 3 * local_[mate / 3] + mate % 3;
  };
  for (std::uint32_t h = 0; h < 3 * count; ++h) {
    const std::uint32_t mate = localMate(h);
    if (mate == kNone || mate < h) continue;
    join(h, nextHalfEdge(mate));
    join(nextHalfEdge(h), mate);
  }
  std::vector<std::uint32_t> vertex(3 * count, kNone);
  std::uint32_t vertices = 0;
  chart.corners.resize(count);
  for (std::uint32_t h = 0; h < 3 * count; ++h) {
    std::uint32_t& v = vertex[find(h)];
    if (v == kNone) v = vertices++;
    chart.corners[h / 3][h % 3] = v;
  }
  chart.uv.assign(vertices, DVec2(0.0));
  for (std::uint32_t h = 0; h < 3 * count; ++h) {
    if (localMate(h) == kNone) chart.border.push_back(h);
  }
  chart.border.shrink_to_fit();
  for (const std::uint32_t t : chart.triangles) {
    local_[t] = kNone;
    chart.area += topology_.area[t];
  }
  return chart;
}

Stretch measureStretch(const Topology& topology, const ChartMesh& chart) {
  Stretch stretch;
  double largest2 = 0;
  for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
    const FlatTriangle flat = flatten(topology, chart.triangles[i]);
    const auto& c = chart.corners[i];
    const DVec2 e1 = chart.uv[c[1]] - chart.uv[c[0]], e2 = chart.uv[c[2]] - chart.uv[c[0]];
    const double det = e1.x * e2.y - e1.y * e2.x;
    stretch.surface += flat.area();
    stretch.plane += 0.5 * det;
    if (!(det > 0)) {
      stretch.valid = false;
      continue;
    }
    const DVec2 du = DVec2(flat.x1 * e2.y - flat.x2 * e1.y, -flat.y2 * e1.y) / det;
    const DVec2 dv = DVec2(flat.x2 * e1.x - flat.x1 * e2.x, flat.y2 * e1.x) / det;
    const double e = glm::dot(du, du), g = glm::dot(dv, dv), f = glm::dot(du, dv);
    stretch.squares += flat.area() * 0.5 * (e + g);
    largest2 = std::max(largest2, 0.5 * (e + g + std::sqrt((e - g) * (e - g) + 4 * f * f)));
  }
  stretch.largest = std::sqrt(largest2);
  stretch.valid = stretch.valid && std::isfinite(stretch.squares);
  return stretch;
}

bool normalizeAndMeasure(const Topology& topology, ChartMesh& chart) {
  const Stretch stretch = measureStretch(topology, chart);
  if (!stretch.valid) return false;
  const double scale = std::sqrt(stretch.surface / stretch.plane);
  for (DVec2& p : chart.uv) p *= scale;
  chart.area = stretch.surface;
  chart.mean_stretch = std::sqrt(stretch.squares / stretch.surface) / scale;
  chart.max_stretch = stretch.largest / scale;
  return true;
}

}  // namespace relume::atlas
