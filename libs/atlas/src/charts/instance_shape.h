// SPDX-License-Identifier: MIT
// Which instances of a mesh may share charts.
#pragma once
#include "relume/core/vec.h"

namespace relume::atlas {

/// How a transform scales lengths: a metric that is the same for all transforms that differ by a similarity,
/// and the similarity's scale.
struct InstanceShape {
  Mat3 metric{
      1.0f};  ///< the identity for similarities; angles and ratios of lengths after it are those in the world
  double scale = 1;  ///< metres in the world per metre of the metric
};
InstanceShape shapeOf(const Mat4& world_from_local);

/// Up to rounding.
bool sameMetric(const Mat3& a, const Mat3& b);

}  // namespace relume::atlas
