// SPDX-License-Identifier: MIT
// Projection, and relaxation by local/global iterations.
// Based on:
//   [LZXGG08] Liu, Zhang, Xu, Gotsman, Gortler. A Local/Global Approach to Mesh Parameterization. 2008. Eq. 3
//   (energy), section 4
//             (local: best rotation per triangle; global: cotangent Laplacian).
//   [SS15]    Smith, Schaefer. Bijective Parameterization with Free Boundaries. 2015. Section 3.3: the
//   largest step before a
//             triangle collapses is the smallest root of a quadratic.
// Beyond [LZXGG08]: a step stops short of the first flip, so a valid map stays valid.
// Limits: what is minimized is rigidity, not L2 stretch itself; the caller measures and keeps the better map.
#include "charts/flat_map.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "relume/core/frame.h"

namespace relume::atlas {
namespace {

constexpr double kStopShort = 0.8;  // share of the way to the first collapse that a step may go

/// Largest t in (0, 1] such that uv + t * step has no triangle flipped for smaller t.
double stepBeforeFlip(const ChartMesh& chart, const std::vector<DVec2>& step) {
  double largest = 1;
  const auto cross = [](DVec2 a, DVec2 b) { return a.x * b.y - a.y * b.x; };
  for (const auto& c : chart.corners) {
    const DVec2 e1 = chart.uv[c[1]] - chart.uv[c[0]], e2 = chart.uv[c[2]] - chart.uv[c[0]];
    const DVec2 s1 = step[c[1]] - step[c[0]], s2 = step[c[2]] - step[c[0]];
    const double a = cross(s1, s2), b = cross(e1, s2) + cross(s1, e2), k = cross(e1, e2);
    const double discriminant = b * b - 4 * a * k;
    if (discriminant < 0) continue;
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    for (const double root : {q != 0 ? k / q : -1.0, a != 0 ? q / a : -1.0}) {
      if (root > 0 && root < largest / kStopShort) largest = std::min(largest, kStopShort * root);
    }
  }
  return largest;
}

}  // namespace

void projectToPlane(const Topology& topology, ChartMesh& chart) {
  glm::dvec3 vector_area(0.0);
  for (const std::uint32_t t : chart.triangles) {
    vector_area += glm::dvec3(topology.normal[t]) * double(topology.area[t]);
  }
  const double length = glm::length(vector_area);
  const Frame frame =
      Frame::about(length > 0 ? Normal(vector_area / length) : topology.normal[chart.triangles[0]]);
  const glm::dvec3 t(frame.t), b(frame.b);
  for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 p(topology.position[topology.triangles[chart.triangles[i]][k]]);
      chart.uv[chart.corners[i][static_cast<std::size_t>(k)]] = {glm::dot(p, t), glm::dot(p, b)};
    }
  }
}

void relaxMap(const Topology& topology, ChartMesh& chart, int iterations) {
  using Matrix = Eigen::SparseMatrix<double>;
  const std::size_t triangles = chart.triangles.size();
  const auto vertices = static_cast<int>(chart.uv.size());
  if (vertices < 4) return;
  std::vector<FlatTriangle> flat(triangles);
  std::vector<std::array<double, 3>> cotangent(triangles);  // of the corner opposite edge (k, k + 1)
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(6 * triangles + 1);
  for (std::size_t i = 0; i < triangles; ++i) {
    flat[i] = flatten(topology, chart.triangles[i]);
    const double x1 = flat[i].x1, x2 = flat[i].x2, y2 = flat[i].y2, twice_area = x1 * y2;
    cotangent[i] = {(x2 * (x2 - x1) + y2 * y2) / twice_area, x1 * x2 / twice_area,
                    x1 * (x1 - x2) / twice_area};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<int>(chart.corners[i][k]),
                 b = static_cast<int>(chart.corners[i][(k + 1) % 3]);
      const double w = cotangent[i][k];
      entries.emplace_back(a, a, w);
      entries.emplace_back(b, b, w);
      entries.emplace_back(std::max(a, b), std::min(a, b), -w);
    }
  }
  Matrix laplacian(vertices, vertices);
  // One vertex is held lightly: translation is free otherwise.
  entries.emplace_back(0, 0, 1.0);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  entries = {};
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> solver(laplacian);
  if (solver.info() != Eigen::Success) return;

  Eigen::MatrixX2d right(vertices, 2);
  std::vector<DVec2> step(chart.uv.size());
  for (int iteration = 0; iteration < iterations; ++iteration) {
    right.setZero();
    right(0, 0) = chart.uv[0].x;
    right(0, 1) = chart.uv[0].y;
    for (std::size_t i = 0; i < triangles; ++i) {
      const DVec2 x[3] = {{0, 0}, {flat[i].x1, 0}, {flat[i].x2, flat[i].y2}};
      double c = 0, s = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const DVec2 e = x[(k + 1) % 3] - x[k];
        const DVec2 u = chart.uv[chart.corners[i][(k + 1) % 3]] - chart.uv[chart.corners[i][k]];
        c += cotangent[i][k] * (e.x * u.x + e.y * u.y);
        s += cotangent[i][k] * (e.x * u.y - e.y * u.x);
      }
      const double length = std::hypot(c, s);
      if (!(length > 0)) continue;
      c /= length, s /= length;
      for (std::size_t k = 0; k < 3; ++k) {
        const DVec2 e = x[(k + 1) % 3] - x[k];
        const double w = cotangent[i][k];
        const double rx = w * (c * e.x - s * e.y), ry = w * (s * e.x + c * e.y);
        const auto a = static_cast<int>(chart.corners[i][k]),
                   b = static_cast<int>(chart.corners[i][(k + 1) % 3]);
        right(a, 0) -= rx, right(a, 1) -= ry;
        right(b, 0) += rx, right(b, 1) += ry;
      }
    }
    const Eigen::MatrixX2d solution = solver.solve(right);
    if (solver.info() != Eigen::Success || !solution.allFinite()) return;
    double moved2 = 0;
    for (int v = 0; v < vertices; ++v) {
      const auto i = static_cast<std::size_t>(v);
      step[i] = DVec2(solution(v, 0), solution(v, 1)) - chart.uv[i];
      moved2 = std::max(moved2, glm::dot(step[i], step[i]));
    }
    const double t = stepBeforeFlip(chart, step);
    for (std::size_t v = 0; v < step.size(); ++v) chart.uv[v] += t * step[v];
    if (t * t * moved2 < 1e-6 * chart.area) break;
  }
}

}  // namespace relume::atlas
