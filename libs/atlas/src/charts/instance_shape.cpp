// SPDX-License-Identifier: MIT
// With M the linear part of a transform, lengths depend on M^T M alone. Its Cholesky factor U (U^T U = M^T M
// / s^2) is the metric: rotations and mirrors drop out, and s is chosen so that det U = 1.
#include "charts/instance_shape.h"

#include <algorithm>
#include <cmath>

namespace relume::atlas {
namespace {

constexpr float kSameShape = 1e-4f;  // relative difference between metrics that counts as rounding
constexpr double kFlattened = 1e-6;  // ratio of volumes below which a transform is singular

}  // namespace

InstanceShape shapeOf(const Mat4& world_from_local) {
  const Mat3 m(world_from_local);
  const glm::dmat3 gram = glm::transpose(glm::dmat3(m)) * glm::dmat3(m);
  const double volume2 = glm::determinant(gram), size2 = (gram[0][0] + gram[1][1] + gram[2][2]) / 3;
  if (!(volume2 > kFlattened * kFlattened * size2 * size2 * size2))
    return {m, 1.0};  // flattened: nothing to share
  const double scale2 = std::cbrt(volume2);
  const glm::dmat3 g = gram / scale2;
  // Upper triangular U with U^T U = g (Cholesky); exactly the identity for similarities.
  InstanceShape shape;
  shape.scale = std::sqrt(scale2);
  double off = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) off = std::max(off, std::abs(g[i][j] - (i == j ? 1.0 : 0.0)));
  }
  if (off < kSameShape) return shape;
  glm::dmat3 u(0.0);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i <= j; ++i) {
      double sum = g[j][i];
      for (int k = 0; k < i; ++k) sum -= u[i][k] * u[j][k];
      u[j][i] = i == j ? std::sqrt(std::max(sum, 0.0)) : sum / u[i][i];
    }
  }
  shape.metric = Mat3(u);
  return shape;
}

bool sameMetric(const Mat3& a, const Mat3& b) {
  float difference = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) difference = std::max(difference, std::abs(a[i][j] - b[i][j]));
  }
  return difference < kSameShape;
}

}  // namespace relume::atlas
