// SPDX-License-Identifier: MIT
// Clusters of triangles that face one way: candidates for charts.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "charts/topology.h"

namespace relume::atlas {

/// A facet may come apart into pieces where its border was straightened. A forest over facets: nodes 0 ..
/// facets - 1 are the facets, every later node joins two earlier ones. A node that proves unfit for a chart
/// is taken apart along the tree.
struct ClusterForest {
  std::vector<std::uint32_t> facet;  ///< per triangle: its facet, kNone where degenerate
  std::uint32_t facets = 0;
  std::vector<std::array<std::uint32_t, 2>> children;  ///< of node facets + i
  std::vector<std::uint32_t> roots;                    ///< nodes without a parent, increasing
};

/// discontinuity_angle: largest angle between neighbouring faces of a facet and across the borders at which
/// facets join; cone_angle: largest angle between a face and the mean normal of its cluster; radians.
ClusterForest growClusters(const Topology& topology, float discontinuity_angle, float cone_angle);

}  // namespace relume::atlas
