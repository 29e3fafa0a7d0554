// SPDX-License-Identifier: MIT
// The computed numbers of a report, each from what it needs alone.
#pragma once
#include <span>
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/bake/registry.h"
#include "relume/bake/report.h"

namespace relume::bake {

/// edges: increasing, at least two.
Histogram histogramOf(std::span<const double> values, std::vector<double> edges);
/// Value below which `share` of the values lie; 0 without values. Reorders them.
double quantile(std::span<double> values, double share);

/// values: shape [pages * height * width][channels]
SeamError seamError(std::span<const atlas::SeamSample> seams, int channels, std::span<const float> values);

/// Texels per metre of surface at a texel: the root of texels per square metre.
double texelDensity(const atlas::SurfacePoint& point);

/// shape of the result: [charts]
std::vector<ChartError> chartErrors(const atlas::Texels& texels, const PointLayer& layer, std::size_t charts);

}  // namespace relume::bake
