// SPDX-License-Identifier: MIT
// A mesh cut into charts, each flat and free of overlap, before packing.
#pragma once
#include <cstdint>
#include <vector>

#include "relume/core/progress.h"
#include "relume/scene/scene.h"

namespace relume::atlas {

struct UnwrapOptions {
  float discontinuity_angle = 1.05f;  ///< radians
  float cone_angle = 1.2f;            ///< radians
  double texel = 0;                   ///< expected size of a texel in the metric, metres
  int gutter = 2;                     ///< texels
  int page_size = 1024;               ///< texels, width and height of a page
};

struct FlatChart {
  std::uint32_t first_vertex = 0, vertex_count = 0;  ///< of Unwrap::uv
  Vec2 extent{0.0f};                                 ///< its uv lie in [0, extent]
  double area = 0;                                   ///< m^2 in the metric
  float mean_stretch = 1, max_stretch = 1;
};

struct Unwrap {
  std::vector<std::uint32_t> source_vertex;  ///< new vertex -> vertex of the mesh
  std::vector<UVec3> triangles;              ///< of new vertices; same order as Mesh::triangles
  std::vector<Vec2> uv;  ///< per new vertex, metres in the metric, per chart from its corner
  std::vector<std::uint32_t> triangle_chart;  ///< index into charts, kNone where degenerate
  std::vector<FlatChart> charts;
};

/// `metric` maps mesh space to the space in which lengths are measured; its determinant is positive.
Unwrap unwrap(const scene::Mesh& mesh, const Mat3& metric, const UnwrapOptions& options, Progress& progress);

}  // namespace relume::atlas
