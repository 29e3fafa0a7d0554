// SPDX-License-Identifier: MIT
// A cluster is projected along its mean normal; where that stretches it is relaxed. What still overlaps
// itself or stretches too much goes back to the two clusters it was joined from. Based on:
//   [IKSZ03] Iones, Krupkin, Sbert, Zhukov. Fast, Realistic Lighting for Video Games. 2003. Section 3,
//   condition 3: a polygon joins a cluster
//            only if it overlaps none of its polygons in the plane. Here for facets that overlap themselves,
//            such as doubled sheets.
#include "charts/flatten.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <span>

#include "charts/flat_map.h"
#include "charts/overlap.h"
#include "relume/core/parallel.h"

namespace relume::atlas {
namespace {

constexpr double kFlatEnough = 1.01;  // mean stretch below which a projection is kept
constexpr double kMostMaxStretch = 4;
constexpr int kRelaxations = 8;
constexpr std::size_t kMostRelaxed =
    50000;                          // triangles; the equations of larger charts would take too much memory
constexpr double kTouching = 1e-6;  // share of a triangle's extent that it may reach into another

using Triangle2 = std::array<DVec2, 3>;

bool separatedAlongEdges(const Triangle2& s, const Triangle2& t) {
  for (std::size_t k = 0; k < 3; ++k) {
    const DVec2 e = s[(k + 1) % 3] - s[k];
    const auto height = [&](DVec2 p) { return e.x * (p.y - s[k].y) - e.y * (p.x - s[k].x); };
    const double own = height(s[(k + 2) % 3]);
    const double reach = std::max({height(t[0]), height(t[1]), height(t[2])});
    if (reach <= kTouching * own) return true;
  }
  return false;
}

/// The triangles of each facet, increasing.
class FacetTriangles {
 public:
  explicit FacetTriangles(const ClusterForest& forest) : first_(forest.facets + 1, 0) {
    for (const std::uint32_t f : forest.facet) {
      if (f != kNone) ++first_[f + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    triangles_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < forest.facet.size(); ++t) {
      if (forest.facet[t] != kNone) triangles_[next[forest.facet[t]]++] = t;
    }
  }
  std::span<const std::uint32_t> operator[](std::uint32_t facet) const {
    return std::span(triangles_).subspan(first_[facet], first_[facet + 1] - first_[facet]);
  }

 private:
  std::vector<std::uint32_t> first_, triangles_;
};

class Flattener {
 public:
  Flattener(const Topology& topology, const ClusterForest& forest, const FacetTriangles& facet_triangles,
            double most_mean_stretch)
      : topology_(topology),
        forest_(forest),
        facet_triangles_(facet_triangles),
        most_mean_stretch_(most_mean_stretch),
        builder_(topology),
        open_(topology.triangleCount(), 0) {}

  void flattenRoot(std::uint32_t root, std::vector<ChartMesh>& charts) {
    std::vector<std::uint32_t> nodes{root};
    while (!nodes.empty()) {
      const std::uint32_t node = nodes.back();
      nodes.pop_back();
      std::vector<ChartMesh> parts;
      bool all_flat = true;
      for (auto& component : componentsOf(node)) {
        parts.push_back(builder_.build(std::move(component)));
        if (flatten(parts.back())) continue;
        all_flat = false;
        if (node >= forest_.facets) break;
        const ChartMesh failed = std::move(parts.back());
        parts.pop_back();
        growWithoutOverlap(failed, parts);
      }
      if (all_flat || node < forest_.facets) {
        std::move(parts.begin(), parts.end(), std::back_inserter(charts));
      } else {
        for (const std::uint32_t child : forest_.children[node - forest_.facets]) nodes.push_back(child);
      }
    }
  }

 private:
  bool flatten(ChartMesh& chart) const {
    projectToPlane(topology_, chart);
    if (!normalizeAndMeasure(topology_, chart)) return false;
    if (chart.mean_stretch > kFlatEnough && chart.triangles.size() <= kMostRelaxed) {
      ChartMesh relaxed = chart;
      relaxMap(topology_, relaxed, kRelaxations);
      if (normalizeAndMeasure(topology_, relaxed) && relaxed.mean_stretch < chart.mean_stretch)
        chart = std::move(relaxed);
    }
    return chart.mean_stretch <= most_mean_stretch_ && chart.max_stretch <= kMostMaxStretch &&
           !overlapsItself(chart);
  }

  std::vector<std::vector<std::uint32_t>> componentsOf(std::uint32_t node) {
    std::vector<std::uint32_t> triangles, stack{node};
    while (!stack.empty()) {
      const std::uint32_t n = stack.back();
      stack.pop_back();
      if (n < forest_.facets) {
        const auto members = facet_triangles_[n];
        triangles.insert(triangles.end(), members.begin(), members.end());
      } else {
        for (const std::uint32_t child : forest_.children[n - forest_.facets]) stack.push_back(child);
      }
    }
    std::sort(triangles.begin(), triangles.end());
    for (const std::uint32_t t : triangles) open_[t] = 1;
    std::vector<std::vector<std::uint32_t>> components;
    for (const std::uint32_t seed : triangles) {
      if (!open_[seed]) continue;
      open_[seed] = 0;
      std::vector<std::uint32_t> found{seed};
      for (std::size_t i = 0; i < found.size(); ++i) {
        for (std::uint32_t e = 0; e < 3; ++e) {
          const std::uint32_t mate = topology_.mate[3 * found[i] + e];
          if (mate == kNone || !open_[mate / 3]) continue;
          open_[mate / 3] = 0;
          found.push_back(mate / 3);
        }
      }
      std::sort(found.begin(), found.end());
      components.push_back(std::move(found));
    }
    return components;
  }

  /// Breadth-first charts out of a projected facet; a triangle that would overlap starts or joins another
  /// one.
  void growWithoutOverlap(const ChartMesh& facet, std::vector<ChartMesh>& charts) {
    std::vector<std::uint32_t> local(facet.triangles);
    const auto indexOf = [&](std::uint32_t t) {
      const auto it = std::lower_bound(local.begin(), local.end(), t);
      return it != local.end() && *it == t ? static_cast<std::uint32_t>(it - local.begin()) : kNone;
    };
    const auto inPlane = [&](std::uint32_t i) {
      const auto& c = facet.corners[i];
      return Triangle2{facet.uv[c[0]], facet.uv[c[1]], facet.uv[c[2]]};
    };
    std::vector<char> taken(local.size(), 0);
    for (std::uint32_t seed = 0; seed < local.size(); ++seed) {
      if (taken[seed]) continue;
      std::vector<std::uint32_t> members{seed};
      std::vector<Triangle2> placed{inPlane(seed)};
      taken[seed] = 1;
      for (std::size_t k = 0; k < members.size(); ++k) {
        for (std::uint32_t e = 0; e < 3; ++e) {
          const std::uint32_t mate = topology_.mate[3 * local[members[k]] + e];
          const std::uint32_t i = mate == kNone ? kNone : indexOf(mate / 3);
          if (i == kNone || taken[i]) continue;
          const Triangle2 triangle = inPlane(i);
          const bool free = std::all_of(placed.begin(), placed.end(), [&](const Triangle2& other) {
            return separatedAlongEdges(triangle, other) || separatedAlongEdges(other, triangle);
          });
          if (!free) continue;
          taken[i] = 1;
          members.push_back(i);
          placed.push_back(triangle);
        }
      }
      std::vector<std::uint32_t> triangles;
      for (const std::uint32_t i : members) triangles.push_back(local[i]);
      std::sort(triangles.begin(), triangles.end());
      ChartMesh chart = builder_.build(triangles);
      if (flatten(chart)) {
        charts.push_back(std::move(chart));
        continue;
      }
      // Rounding: slivers that touch. A triangle alone always lies flat.
      for (const std::uint32_t t : triangles) {
        ChartMesh single = builder_.build({t});
        flatten(single);
        charts.push_back(std::move(single));
      }
    }
  }

  const Topology& topology_;
  const ClusterForest& forest_;
  const FacetTriangles& facet_triangles_;
  double most_mean_stretch_;
  ChartMeshBuilder builder_;
  std::vector<char> open_;
};

}  // namespace

std::vector<ChartMesh> flattenClusters(const Topology& topology, const ClusterForest& forest,
                                       double most_mean_stretch, Progress& progress) {
  const FacetTriangles facet_triangles(forest);
  // A flattener holds an array over all triangles, so each serves many roots; their charts follow in the
  // order of the roots.
  const std::size_t grain = std::max<std::size_t>(16, forest.roots.size() / 16);
  std::vector<std::vector<ChartMesh>> parts((forest.roots.size() + grain - 1) / grain);
  parallelFor(forest.roots.size(), grain, [&](std::size_t begin, std::size_t end) {
    Flattener flattener(topology, forest, facet_triangles, most_mean_stretch);
    std::vector<ChartMesh>& charts = parts[begin / grain];
    charts.reserve(end - begin);
    for (std::size_t r = begin; r < end; ++r) {
      progress.throwIfCancelled();
      flattener.flattenRoot(forest.roots[r], charts);
    }
  });
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  std::vector<ChartMesh> charts;
  charts.reserve(count);
  for (auto& part : parts) {
    std::move(part.begin(), part.end(), std::back_inserter(charts));
    part = {};
  }
  return charts;
}

}  // namespace relume::atlas
