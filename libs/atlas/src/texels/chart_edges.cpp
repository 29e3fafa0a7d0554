// SPDX-License-Identifier: MIT
// Edges are matched by the atlas's own vertices: within a chart, triangles that share an edge share its two
// vertices.
#include "texels/chart_edges.h"

#include <algorithm>
#include <array>

#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::atlas {
namespace {

// Coordinates go through node transforms in single precision; modelled kits are rounded to about that too.
constexpr float kRelativeTolerance = 1e-5f;
// Nobody sees a gap of a fiftieth of a texel.
constexpr float kTexelTolerance = 0.02f;
// Edges shorter than this many tolerances are as good as points.
constexpr float kLeastLength = 10.0f;

float largest(Vec3 v) {
  v = glm::abs(v);
  return std::max({v.x, v.y, v.z});
}

std::pair<std::uint32_t, std::uint32_t> endsOf(const InstanceUv& uv, std::uint32_t corner) {
  const UVec3 t = uv.triangles[corner / 3];
  const int k = static_cast<int>(corner % 3);
  return {t[k], t[(k + 1) % 3]};
}

/// Corners whose edge only one triangle of its chart has; increasing.
std::vector<std::uint32_t> borderCorners(const InstanceUv& uv) {
  // Bucket by the lower vertex, then look for equal higher vertices (and charts) in each bucket.
  std::vector<std::uint32_t> first(uv.uv.size() + 2, 0);
  const auto corners = static_cast<std::uint32_t>(3 * uv.triangles.size());
  const auto used = [&](std::uint32_t corner) { return uv.triangle_chart[corner / 3] != scene::kNone; };
  const auto low = [&](std::uint32_t corner) {
    const auto [a, b] = endsOf(uv, corner);
    return std::min(a, b);
  };
  for (std::uint32_t c = 0; c < corners; ++c) {
    if (used(c)) ++first[low(c) + 2];
  }
  for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint32_t> bucketed(first.back());
  for (std::uint32_t c = 0; c < corners; ++c) {
    if (used(c)) bucketed[first[low(c) + 1]++] = c;
  }
  std::vector<std::uint32_t> border;
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    const auto begin = bucketed.begin() + first[v], end = bucketed.begin() + first[v + 1];
    const auto key = [&](std::uint32_t c) {
      const auto [a, b] = endsOf(uv, c);
      return std::pair(std::max(a, b), uv.triangle_chart[c / 3]);
    };
    std::sort(begin, end,
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    for (auto i = begin; i != end;) {
      auto next = i + 1;
      while (next != end && key(*next) == key(*i)) ++next;
      if (next - i == 1) border.push_back(*i);
      i = next;
    }
  }
  std::sort(border.begin(), border.end());
  return border;
}

}  // namespace

std::vector<ChartEdge> chartEdges(const scene::Scene& scene, const Atlas& atlas) {
  std::vector<std::vector<ChartEdge>> per_instance(atlas.instances.size());
  parallelFor(atlas.instances.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const InstanceUv& uv = atlas.instances[i];
      const scene::Instance& instance = scene.instances[uv.instance];
      const scene::Mesh& mesh = scene.meshes[instance.mesh];
      for (const std::uint32_t corner : borderCorners(uv)) {
        const auto [a, b] = endsOf(uv, corner);
        const auto world = [&](std::uint32_t v) {
          return Point(instance.world_from_local * Vec4(mesh.positions[uv.source_vertex[v]], 1.0f));
        };
        ChartEdge edge{world(a), world(b), static_cast<std::uint32_t>(i), corner, 0};
        const float metres = edge.length(), texels = glm::length(uv.uv[b] - uv.uv[a]);
        const float rounding = kRelativeTolerance * std::max(largest(edge.p0), largest(edge.p1));
        if (!(texels > 0) || !(metres > kLeastLength * rounding)) continue;
        edge.tolerance =
            std::max(rounding, std::min(kTexelTolerance * metres / texels, metres / kLeastLength));
        per_instance[i].push_back(edge);
      }
      per_instance[i].shrink_to_fit();
    }
  });
  std::size_t total = 0;
  for (const auto& edges : per_instance) total += edges.size();
  std::vector<ChartEdge> all;
  all.reserve(total);
  for (auto& edges : per_instance) {
    all.insert(all.end(), edges.begin(), edges.end());
    std::vector<ChartEdge>().swap(edges);
  }
  return all;
}

Vec2 pageAt(const Atlas& atlas, const ChartEdge& edge, float t) {
  const InstanceUv& uv = atlas.instances[edge.uv];
  const auto [a, b] = endsOf(uv, edge.corner);
  return (1 - t) * uv.uv[a] + t * uv.uv[b];
}

scene::Hit hitAt(const Atlas& atlas, const ChartEdge& edge, float t) {
  std::array<float, 3> weight{};
  weight[edge.corner % 3] = 1 - t;
  weight[(edge.corner + 1) % 3] = t;
  return {atlas.instances[edge.uv].instance, edge.corner / 3, weight[1], weight[2]};
}

}  // namespace relume::atlas
