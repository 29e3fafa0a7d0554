// SPDX-License-Identifier: MIT
#include "charts/reuse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "charts/centre_counter.h"
#include "charts/footprint.h"
#include "charts/topology.h"

namespace relume::atlas {
namespace {

constexpr float kOutside = 1e-3f;  // how far beyond [0, 1] counts as rounding
constexpr double kMostBad = 1e-3;  // share of texels or surface that may be bad: touching edges, slivers
constexpr double kMostDensityRatio = 4;  // between islands
constexpr double kMostMeanStretch = 2;
constexpr double kIslandOfNote =
    1e-3;  // share of the surface below which an island's density does not matter
constexpr int kProofSizes[] = {256, 512, 1024};
constexpr float kLargestPicture = 8192;   // texels
constexpr float kMargin = 1.0f / 512.0f;  // as in packing

double cross(Vec2 a, Vec2 b) { return double(a.x) * b.y - double(a.y) * b.x; }

/// Triangles that share a place of the surface and its uv hang together. Returns the island of each triangle,
/// kNone where degenerate.
std::vector<std::uint32_t> findIslands(const scene::Mesh& mesh, const Topology& topology,
                                       std::uint32_t& count) {
  const auto& uv = mesh.uv[1];
  std::vector<std::uint32_t> order(uv.size()), parent(uv.size());
  std::iota(order.begin(), order.end(), 0u);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto key = [&](std::uint32_t v) { return std::tuple(topology.point[v], uv[v].x, uv[v].y); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple_cat(key(a), std::tuple(a)) < std::tuple_cat(key(b), std::tuple(b));
  });
  const auto find = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent[std::max(a, b)] = std::min(a, b);
  };
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i]) == key(order[i - 1])) join(order[i], order[i - 1]);
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (topology.degenerate(t)) continue;
    join(mesh.triangles[t][0], mesh.triangles[t][1]);
    join(mesh.triangles[t][0], mesh.triangles[t][2]);
  }
  std::vector<std::uint32_t> island_of_root(uv.size(), kNone), island(mesh.triangles.size(), kNone);
  count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (topology.degenerate(t)) continue;
    std::uint32_t& i = island_of_root[find(mesh.triangles[t][0])];
    if (i == kNone) i = count++;
    island[t] = i;
  }
  return island;
}

/// Areas and stretch of islands and of the whole layout.
struct Sums {
  double surface = 0, plane = 0, squares = 0, largest = 0;
};

void addStretch(Vec2 e1, Vec2 e2, const glm::dvec3& p1, const glm::dvec3& p2, double area, Sums& sums) {
  const double det = cross(e1, e2);
  sums.surface += area;
  sums.plane += 0.5 * std::abs(det);
  if (det == 0) return;
  const glm::dvec3 du = (p1 * double(e2.y) - p2 * double(e1.y)) / det,
                   dv = (p2 * double(e1.x) - p1 * double(e2.x)) / det;
  const double e = glm::dot(du, du), g = glm::dot(dv, dv), f = glm::dot(du, dv);
  sums.squares += area * 0.5 * (e + g);
  sums.largest = std::max(sums.largest, std::sqrt(0.5 * (e + g + std::sqrt((e - g) * (e - g) + 4 * f * f))));
}

Fault overlapOf(const scene::Mesh& mesh, const Topology& topology) {
  for (const int size : kProofSizes) {
    CentreCounter counter(size, size);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (topology.degenerate(t)) continue;
      const UVec3 c = mesh.triangles[t];
      const auto texels = static_cast<float>(size);
      counter.add(mesh.uv[1][c[0]] * texels, mesh.uv[1][c[1]] * texels, mesh.uv[1][c[2]] * texels);
    }
    const auto covered = static_cast<double>(counter.claimed()),
               twice = static_cast<double>(counter.claimedTwice());
    if (twice > kMostBad * covered) {
      return fmt::format("{:.2f} % of its texels overlap at {} x {} (at most {:.1f} %)",
                         100 * twice / covered, size, size, 100 * kMostBad);
    }
  }
  return {};
}

}  // namespace

std::optional<Reused> reuseLayout(const scene::Mesh& mesh, const Mat3& metric, Fault& fault) {
  const auto& uv = mesh.uv[1];
  fault.clear();
  Vec2 lo(kInfinity), hi(-kInfinity);
  for (const UVec3 t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec2 p = uv[t[k]];
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
        fault = fmt::format("vertex {} is not finite", t[k]);
        return std::nullopt;
      }
      lo = glm::min(lo, p), hi = glm::max(hi, p);
    }
  }
  if (lo.x < -kOutside || lo.y < -kOutside || hi.x > 1 + kOutside || hi.y > 1 + kOutside) {
    fault = fmt::format("it reaches from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f}), outside [0, 1]", lo.x, lo.y,
                        hi.x, hi.y);
    return std::nullopt;
  }
  const Topology topology = connect(mesh, metric);
  Reused reused;
  Unwrap& layout = reused.layout;
  std::uint32_t islands = 0;
  layout.triangle_chart = findIslands(mesh, topology, islands);
  std::vector<Sums> sums(islands);
  Sums all;
  double flat_surface = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (topology.degenerate(t)) continue;
    const UVec3 c = mesh.triangles[t];
    const Vec2 e1 = uv[c[1]] - uv[c[0]], e2 = uv[c[2]] - uv[c[0]];
    const glm::dvec3 origin(topology.position[c[0]]);
    const glm::dvec3 p1 = glm::dvec3(topology.position[c[1]]) - origin,
                     p2 = glm::dvec3(topology.position[c[2]]) - origin;
    for (Sums* s : {&sums[layout.triangle_chart[t]], &all}) addStretch(e1, e2, p1, p2, topology.area[t], *s);
    if (cross(e1, e2) == 0) flat_surface += topology.area[t];
  }
  if (!(all.plane > 0) || flat_surface > kMostBad * all.surface) {
    fault = fmt::format("{:.1f} % of the surface has no area in it",
                        all.surface > 0 ? 100 * flat_surface / all.surface : 100.0);
    return std::nullopt;
  }
  double densest = 0, sparsest = std::numeric_limits<double>::infinity();
  for (const Sums& s : sums) {
    if (s.surface < kIslandOfNote * all.surface) continue;
    densest = std::max(densest, std::sqrt(s.plane / s.surface));
    sparsest = std::min(sparsest, std::sqrt(s.plane / s.surface));
  }
  if (densest > kMostDensityRatio * sparsest) {
    fault = fmt::format("its texel density varies {:.1f} times between islands (at most {:.0f})",
                        densest / sparsest, kMostDensityRatio);
    return std::nullopt;
  }
  const double mean_stretch = std::sqrt(all.squares / all.surface * all.plane / all.surface);
  if (mean_stretch > kMostMeanStretch) {
    fault = fmt::format("it stretches the surface {:.1f} times in the mean (at most {:.0f})", mean_stretch,
                        kMostMeanStretch);
    return std::nullopt;
  }
  fault = overlapOf(mesh, topology);
  if (!fault.empty()) return std::nullopt;

  reused.extent = hi - lo;
  reused.metres_per_unit = std::sqrt(all.surface / all.plane);
  layout.source_vertex.resize(uv.size());
  std::iota(layout.source_vertex.begin(), layout.source_vertex.end(), 0u);
  layout.triangles = mesh.triangles;
  layout.uv.resize(uv.size());
  std::transform(uv.begin(), uv.end(), layout.uv.begin(), [&](Vec2 p) { return p - lo; });
  for (const Sums& s : sums) {
    FlatChart chart;
    chart.area = s.surface;
    chart.mean_stretch = static_cast<float>(std::sqrt(s.squares / s.surface) / reused.metres_per_unit);
    chart.max_stretch = static_cast<float>(s.largest / reused.metres_per_unit);
    layout.charts.push_back(chart);
  }
  return reused;
}

bool guttersSuffice(const Reused& reused, double texels, int gutter, Fault& fault) {
  // A coarser picture is the stricter one, so a limit on its size is safe.
  const auto scale =
      std::min(static_cast<float>(texels), kLargestPicture / std::max(reused.extent.x, reused.extent.y));
  const IVec2 size = IVec2(glm::ceil(reused.extent * scale)) + 2;
  // Each texel knows the first island that covers it; the triangles of each island in turn.
  std::vector<std::uint32_t> owner(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y),
                                   kNone);
  const auto at = [&](int x, int y) -> std::uint32_t& {
    return owner[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) +
                 static_cast<std::size_t>(x)];
  };
  const Unwrap& layout = reused.layout;
  std::size_t covered = 0, close = 0;
  for (std::uint32_t t = 0; t < layout.triangles.size(); ++t) {
    if (layout.triangle_chart[t] == kNone) continue;
    Vec2 corner[3], lo(kInfinity), hi(-kInfinity);
    for (int k = 0; k < 3; ++k) {
      corner[k] = layout.uv[layout.triangles[t][k]] * scale + 1.0f;
      lo = glm::min(lo, corner[k]), hi = glm::max(hi, corner[k]);
    }
    const IVec2 first = glm::max(IVec2(0), IVec2(glm::floor(lo)) - 1),
                last = glm::min(size - 1, IVec2(glm::ceil(hi)));
    if (last.x < first.x || last.y < first.y) continue;
    BitGrid grid(last.x - first.x + 1, last.y - first.y + 1);
    coverTriangle(grid, corner[0] - Vec2(first), corner[1] - Vec2(first), corner[2] - Vec2(first), kMargin);
    for (int y = 0; y < grid.height(); ++y) {
      for (int x = 0; x < grid.width(); ++x) {
        std::uint32_t& o = at(first.x + x, first.y + y);
        if (!grid.get(x, y) || o == layout.triangle_chart[t]) continue;
        if (o != kNone) ++close;
        o = layout.triangle_chart[t];
      }
    }
  }
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const std::uint32_t o = at(x, y);
      if (o == kNone) continue;
      ++covered;
      bool alone = true;
      for (int dy = -gutter; dy <= gutter && alone; ++dy) {
        for (int dx = -gutter; dx <= gutter && alone; ++dx) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= size.x || y + dy >= size.y) continue;
          const std::uint32_t other = at(x + dx, y + dy);
          alone = other == kNone || other == o;
        }
      }
      if (!alone) ++close;
    }
  }
  if (static_cast<double>(close) <= kMostBad * static_cast<double>(covered)) return true;
  fault = fmt::format(
      "{:.1f} % of its texels lie within {} texels of another island when it is {:.0f} texels wide",
      100.0 * static_cast<double>(close) / static_cast<double>(covered), gutter, texels);
  return false;
}

}  // namespace relume::atlas
