// SPDX-License-Identifier: MIT
// Large hollow charts cut into parts that pack well.
#pragma once
#include <vector>

#include "charts/chart_mesh.h"

namespace relume::atlas {

struct SplitOptions {
  double texel = 0;      ///< expected size, metres
  int gutter = 2;        ///< texels
  int page_size = 1024;  ///< texels, width and height of a page
};

/// Cuts charts that are about as long as a page, and charts whose boxes leave much of a page empty, such as
/// frames and arcs, between triangles; every part keeps its map.
void splitHollowCharts(const Topology& topology, const SplitOptions& options, std::vector<ChartMesh>& charts);

}  // namespace relume::atlas
