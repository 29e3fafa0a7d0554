// SPDX-License-Identifier: MIT
// Clusters laid flat.
#pragma once
#include <vector>

#include "charts/chart_mesh.h"
#include "charts/grow.h"
#include "relume/core/progress.h"

namespace relume::atlas {

/// Charts that are valid, free of overlap and below the stretch bound, out of a forest: a node that cannot be
/// laid flat is taken apart. Every triangle that is not degenerate lies in one chart. Inside a chart all
/// mates are joined.
std::vector<ChartMesh> flattenClusters(const Topology& topology, const ClusterForest& forest,
                                       double most_mean_stretch, Progress& progress);

}  // namespace relume::atlas
