// SPDX-License-Identifier: MIT
// Small charts joined to their neighbours.
#pragma once
#include <vector>

#include "charts/chart_mesh.h"

namespace relume::atlas {

struct JoinOptions {
  double texel = 0;    ///< expected size, metres
  int gutter = 2;      ///< texels
  double longest = 0;  ///< of the box of a joined chart, metres
  float discontinuity_angle =
      1.05f;  ///< radians: only charts that gutters would dwarf are unfolded across sharper edges
  double most_mean_stretch = 1.1;  ///< of a joined chart
};

/// Joins charts of one mesh while the boxes they need in the atlas shrink. Each chart stays free of overlap,
/// and places of a chart that come within a gutter of each other in the plane are near each other in space
/// too.
void joinCharts(const Topology& topology, const JoinOptions& options, std::vector<ChartMesh>& charts);

}  // namespace relume::atlas
