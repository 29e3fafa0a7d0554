// SPDX-License-Identifier: MIT
// Grow, lay flat, cut what is hollow, join what is small; then write the charts out as vertices and texture
// coordinates.
#include "charts/unwrap.h"

#include <algorithm>
#include <utility>

#include "charts/box.h"
#include "charts/chart_mesh.h"
#include "charts/flatten.h"
#include "charts/grow.h"
#include "charts/join.h"
#include "charts/overlap.h"
#include "charts/split.h"
#include "charts/topology.h"

namespace relume::atlas {
namespace {

constexpr double kSlit = 0.02;            // texels
constexpr double kLongestJoined = 0.5;    // share of the width of a page
constexpr double kMostMeanStretch = 1.1;  // of a chart; the bound of a whole scene is 1.15

/// Turns the uv so that the smallest box about the chart lies along the axes with its corner in the origin.
void alignToBox(ChartMesh& chart) {
  const OrientedBox box = boxOf(chart);
  for (DVec2& p : chart.uv) p = box.toBox(p) - box.lo;
}

/// Appends a chart. A mesh vertex becomes one vertex for each fan of each chart that it lies in.
void emit(const scene::Mesh& mesh, ChartMesh chart, double slit, Unwrap& result) {
  closeSlits(chart, slit);
  alignToBox(chart);
  FlatChart flat;
  flat.first_vertex = static_cast<std::uint32_t>(result.uv.size());
  flat.area = chart.area;
  flat.mean_stretch = static_cast<float>(chart.mean_stretch);
  flat.max_stretch = static_cast<float>(chart.max_stretch);
  std::vector<std::pair<std::uint64_t, std::uint64_t>> corners;  // (source, fan), (triangle, corner)
  corners.reserve(3 * chart.triangles.size());
  for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
    const std::uint32_t t = chart.triangles[i];
    result.triangle_chart[t] = static_cast<std::uint32_t>(result.charts.size());
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t source = mesh.triangles[t][static_cast<int>(k)];
      corners.push_back({source << 32 | chart.corners[i][k], std::uint64_t{3} * t + k});
    }
  }
  std::sort(corners.begin(), corners.end());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [key, corner] = corners[i];
    if (i == 0 || key != corners[i - 1].first) {
      result.source_vertex.push_back(static_cast<std::uint32_t>(key >> 32));
      result.uv.push_back(Vec2(chart.uv[static_cast<std::uint32_t>(key)]));
      flat.extent = glm::max(flat.extent, result.uv.back());
    }
    result.triangles[corner / 3][static_cast<int>(corner % 3)] =
        static_cast<std::uint32_t>(result.uv.size()) - 1;
  }
  flat.vertex_count = static_cast<std::uint32_t>(result.uv.size()) - flat.first_vertex;
  result.charts.push_back(flat);
}

}  // namespace

Unwrap unwrap(const scene::Mesh& mesh, const Mat3& metric, const UnwrapOptions& options, Progress& progress) {
  const Topology topology = connect(mesh, metric);
  std::vector<ChartMesh> charts;
  {
    const ClusterForest forest = growClusters(topology, options.discontinuity_angle, options.cone_angle);
    progress.throwIfCancelled();
    charts = flattenClusters(topology, forest, kMostMeanStretch, progress);
  }
  const double page = options.page_size * options.texel;
  splitHollowCharts(topology, {options.texel, options.gutter, options.page_size}, charts);
  joinCharts(
      topology,
      {options.texel, options.gutter, kLongestJoined * page, options.discontinuity_angle, kMostMeanStretch},
      charts);

  Unwrap result;
  result.triangles.resize(mesh.triangles.size(), UVec3(0));
  result.triangle_chart.assign(mesh.triangles.size(), kNone);
  for (ChartMesh& chart : charts) emit(mesh, std::move(chart), kSlit * options.texel, result);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (result.triangle_chart[t] != kNone) continue;
    // Degenerate: each gets vertices of its own in the corner, so that the attributes stay as they are.
    for (int k = 0; k < 3; ++k) {
      result.triangles[t][k] = static_cast<std::uint32_t>(result.uv.size());
      result.source_vertex.push_back(mesh.triangles[t][k]);
      result.uv.push_back(Vec2(0.0f));
    }
  }
  return result;
}

}  // namespace relume::atlas
