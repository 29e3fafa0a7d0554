// SPDX-License-Identifier: MIT
#include "charts/topology.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "relume/core/vec.h"

namespace relume::atlas {
namespace {

// A triangle is degenerate when its height is less than this share of its longest edge: its directions are
// then rounding noise.
constexpr double kFlatness = 1e-6;

std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ull;
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ull;
  return x ^ (x >> 32);
}

// Open addressing over positions; -0 equals 0 because the sum with +0 makes it so.
std::vector<std::uint32_t> weld(const std::vector<Point>& positions) {
  const auto count = static_cast<std::uint32_t>(positions.size());
  const std::size_t size = std::bit_ceil(std::max<std::size_t>(16, std::size_t{count} * 3 / 2));
  std::vector<std::uint32_t> table(size, kNone), first(count);
  for (std::uint32_t v = 0; v < count; ++v) {
    const Vec3 p = positions[v] + Vec3(0.0f);
    const std::uint64_t xy =
        (std::uint64_t{std::bit_cast<std::uint32_t>(p.x)} << 32) | std::bit_cast<std::uint32_t>(p.y);
    std::size_t slot = mix(mix(xy) + std::bit_cast<std::uint32_t>(p.z)) & (size - 1);
    while (table[slot] != kNone && positions[table[slot]] != p) slot = (slot + 1) & (size - 1);
    if (table[slot] == kNone) table[slot] = v;
    first[v] = table[slot];
  }
  return first;
}

void measure(const scene::Mesh& mesh, Topology& topology) {
  const std::size_t count = mesh.triangles.size();
  topology.normal.assign(count, Vec3(0.0f));
  topology.area.assign(count, 0.0f);
  for (std::size_t t = 0; t < count; ++t) {
    const UVec3 c = mesh.triangles[t];
    const glm::dvec3 a(topology.position[c[0]]), b(topology.position[c[1]]), d(topology.position[c[2]]);
    const glm::dvec3 n = glm::cross(b - a, d - a);
    const double twice_area = glm::length(n);
    const double longest2 =
        std::max({glm::dot(b - a, b - a), glm::dot(d - a, d - a), glm::dot(d - b, d - b)});
    const auto area = static_cast<float>(0.5 * twice_area);
    if (!(twice_area > kFlatness * longest2) || !(area > 0.0f) || !std::isfinite(area)) continue;
    topology.normal[t] = Vec3(n / twice_area);
    topology.area[t] = area;
  }
}

struct KeyedEdge {
  std::uint64_t key;  // the two points, smaller one high
  std::uint32_t half_edge;
  auto operator<=>(const KeyedEdge&) const = default;
};

struct Candidate {
  float flatness;
  std::uint32_t a, b;
};

}  // namespace

Topology connect(const scene::Mesh& mesh, const Mat3& metric) {
  Topology topology;
  topology.triangles = mesh.triangles;
  topology.point = weld(mesh.positions);
  topology.position.resize(mesh.positions.size());
  std::transform(mesh.positions.begin(), mesh.positions.end(), topology.position.begin(),
                 [&](Point p) { return metric * p; });
  measure(mesh, topology);

  const std::size_t half_edges = 3 * mesh.triangles.size();
  topology.mate.assign(half_edges, kNone);
  const auto origin = [&](std::uint32_t h) { return topology.point[topology.vertex(h)]; };
  std::vector<KeyedEdge> edges;
  edges.reserve(half_edges);
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    if (topology.degenerate(h / 3)) continue;
    const std::uint64_t a = origin(h), b = origin(nextHalfEdge(h));
    edges.push_back({(std::min(a, b) << 32) | std::max(a, b), h});
  }
  std::sort(edges.begin(), edges.end());

  std::vector<Candidate> candidates;
  for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
    for (end = begin + 1; end < edges.size() && edges[end].key == edges[begin].key;) ++end;
    candidates.clear();
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j) {
        const std::uint32_t a = edges[i].half_edge, b = edges[j].half_edge;
        if (origin(a) == origin(b)) continue;
        candidates.push_back({glm::dot(topology.normal[a / 3], topology.normal[b / 3]), a, b});
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& x, const Candidate& y) { return x.flatness > y.flatness; });
    for (const Candidate& c : candidates) {
      if (topology.mate[c.a] != kNone || topology.mate[c.b] != kNone) continue;
      topology.mate[c.a] = c.b;
      topology.mate[c.b] = c.a;
    }
  }
  return topology;
}

}  // namespace relume::atlas
