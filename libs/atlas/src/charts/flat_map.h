// SPDX-License-Identifier: MIT
// Maps of a chart into the plane.
#pragma once
#include "charts/chart_mesh.h"

namespace relume::atlas {

/// Orthogonal projection along the mean normal. Valid (every triangle counter-clockwise) when all faces lie
/// within a right angle of it.
void projectToPlane(const Topology& topology, ChartMesh& chart);

/// Lowers stretch from a valid map by at most `iterations` of as-rigid-as-possible; every step keeps the map
/// valid.
void relaxMap(const Topology& topology, ChartMesh& chart, int iterations);

}  // namespace relume::atlas
