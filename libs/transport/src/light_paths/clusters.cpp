// SPDX-License-Identifier: MIT
#include "light_paths/clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

constexpr int kRounds = 16;
constexpr std::size_t kGrain = 1024;  // pieces

/// Bits of a coordinate in [0, 1), 10 of them, spread for a Morton code of three.
std::uint32_t spread3(float x) {
  auto v = static_cast<std::uint32_t>(std::clamp(x, 0.0f, 0.999f) * 1024.0f);
  v = (v | (v << 16)) & 0x030000ffu;
  v = (v | (v << 8)) & 0x0300f00fu;
  v = (v | (v << 4)) & 0x030c30c3u;
  return (v | (v << 2)) & 0x09249249u;
}

/// Where normals point to most: one of six ways.
std::uint32_t facing(Normal n) {
  const Vec3 a = glm::abs(n);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return static_cast<std::uint32_t>(2 * axis + (n[axis] < 0));
}

/// Pieces along a curve through space, those that face one way after another.
std::vector<std::uint32_t> inOrder(std::span<const Piece> pieces) {
  Box3 box;
  for (const Piece& p : pieces) box.add(p.position);
  const float scale = 1.0f / std::max({box.extent().x, box.extent().y, box.extent().z, 1e-20f});
  std::vector<std::uint64_t> key(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Vec3 at = (pieces[i].position - box.lo) * scale;
    key[i] = (std::uint64_t{facing(pieces[i].normal)} << 32) | (spread3(at.x) << 2) | (spread3(at.y) << 1) |
             spread3(at.z);
  }
  std::vector<std::uint32_t> order(pieces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return std::pair(key[a], a) < std::pair(key[b], b); });
  return order;
}

/// One of every share of the area along the curve.
std::vector<Feature> firstCentres(std::span<const Piece> pieces, std::span<const Feature> features,
                                  std::size_t count, std::uint64_t seed) {
  double area = 0, so_far = 0;
  for (const Piece& p : pieces) area += static_cast<double>(p.area);
  const double offset = static_cast<double>(sobol2(0, streamOf(seed, 0, 0)).x);
  std::vector<Feature> centres;
  for (const std::uint32_t i : inOrder(pieces)) {
    so_far += static_cast<double>(pieces[i].area);
    if (so_far >= (static_cast<double>(centres.size()) + offset) * area / static_cast<double>(count) &&
        centres.size() < count)
      centres.push_back(features[i]);
  }
  if (centres.empty()) centres.push_back(features[0]);
  return centres;
}

/// Means of clusters. Those that have no piece become the worst placed pieces.
void moveCentres(std::span<const Piece> pieces, std::span<const Feature> features,
                 std::span<const std::uint32_t> of, std::vector<Feature>& centres) {
  std::vector<std::array<double, 6>> sum(centres.size(), std::array<double, 6>{});
  std::vector<double> weight(centres.size(), 0.0);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const double w = std::max(static_cast<double>(pieces[i].area), 1e-30);
    weight[of[i]] += w;
    for (std::size_t a = 0; a < 6; ++a) sum[of[i]][a] += w * static_cast<double>(features[i][a]);
  }
  std::vector<std::size_t> empty;
  for (std::size_t c = 0; c < centres.size(); ++c) {
    if (weight[c] == 0.0) {
      empty.push_back(c);
      continue;
    }
    for (std::size_t a = 0; a < 6; ++a) centres[c][a] = static_cast<float>(sum[c][a] / weight[c]);
  }
  if (empty.empty()) return;
  std::vector<std::pair<float, std::uint32_t>> worst(features.size());
  for (std::uint32_t i = 0; i < features.size(); ++i)
    worst[i] = {-pieces[i].area * squaredDistance(features[i], centres[of[i]]), i};
  const std::size_t some = std::min(empty.size(), worst.size());
  std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(some), worst.end());
  for (std::size_t k = 0; k < some; ++k) centres[empty[k]] = features[worst[k].second];
}

/// Numbers clusters without gaps and takes their means.
void renumber(std::span<const Piece> pieces, std::span<const Feature> features, Clusters& clusters) {
  std::vector<std::uint32_t> number(
      *std::max_element(clusters.of.begin(), clusters.of.end()) + std::size_t{1}, scene::kNone);
  for (const std::uint32_t c : clusters.of) number[c] = 0;
  std::uint32_t count = 0;
  for (std::uint32_t& n : number)
    if (n == 0) n = count++;
  for (std::uint32_t& c : clusters.of) c = number[c];
  clusters.centre.assign(count, Feature{});
  moveCentres(pieces, features, clusters.of, clusters.centre);
}

std::vector<Feature> featuresOf(std::span<const Piece> pieces, const Clusters& clusters) {
  std::vector<Feature> features;
  features.reserve(pieces.size());
  for (const Piece& p : pieces) features.push_back(clusters.feature(p.position, p.normal));
  return features;
}

float sideOf(std::span<const Piece> pieces, std::size_t count) {
  double area = 0;
  for (const Piece& p : pieces) area += static_cast<double>(p.area);
  return static_cast<float>(std::sqrt(area / static_cast<double>(std::max<std::size_t>(count, 1))));
}

}  // namespace

Feature Clusters::feature(Point p, Normal n) const {
  const Vec3 m = normal_length * n;
  return {p.x, p.y, p.z, m.x, m.y, m.z};
}

Clusters makeClusters(std::span<const Piece> pieces, std::size_t count, float normal_weight,
                      std::uint64_t seed, Progress& progress) {
  Clusters clusters;
  if (pieces.empty()) return clusters;
  clusters.normal_length = std::max(normal_weight * sideOf(pieces, count), 1e-20f);
  const std::vector<Feature> features = featuresOf(pieces, clusters);
  clusters.centre = firstCentres(pieces, features, count, seed);
  clusters.of.assign(pieces.size(), 0);
  for (int round = 0; round < kRounds; ++round) {
    const Nearest nearest(clusters.centre);
    parallelFor(pieces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Nearest::Found found;
        nearest.find(features[i], {&found, 1});
        clusters.of[i] = found.index;
      }
    });
    progress.throwIfCancelled();
    moveCentres(pieces, features, clusters.of, clusters.centre);
  }
  renumber(pieces, features, clusters);
  return clusters;
}

namespace {

/// From how far above the surface pieces look, in sides of a cluster. Low enough to be parted by low walls
/// or not at all: seen from either height is seen.
constexpr float kHeights[] = {0.1f, 0.5f};
constexpr std::size_t kCandidates = 8;  // clusters that a piece may go to
constexpr int kMostParts = 4;           // of a cluster that walls divide

class Views {
 public:
  Views(const trace::Tracer& tracer, std::span<const Piece> pieces, float side)
      : tracer_(tracer), places_(pieces.size()) {
    parallelFor(pieces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Point start = trace::offsetOrigin(pieces[i].position, pieces[i].normal);
        const float room = tracer_.intersect({start, pieces[i].normal, kHeights[1] * side}).t;
        for (std::size_t h = 0; h < std::size(kHeights); ++h)
          places_[i][h] = start + std::min(kHeights[h] * side, 0.5f * room) * pieces[i].normal;
      }
    });
  }
  bool seen(std::size_t a, std::size_t b) const {
    for (std::size_t h = 0; h < std::size(kHeights); ++h) {
      const Vec3 way = places_[b][h] - places_[a][h];
      const float length = glm::length(way);
      if (!(length > 0) || !tracer_.occluded({places_[a][h], way / length, length})) return true;
    }
    return false;
  }

 private:
  const trace::Tracer& tracer_;
  std::vector<std::array<Point, std::size(kHeights)>> places_;
};

}  // namespace

void partAtWalls(const trace::Tracer& tracer, std::span<const Piece> pieces, Clusters& clusters,
                 Progress& progress) {
  if (pieces.empty()) return;
  const Views views(tracer, pieces, sideOf(pieces, clusters.size()));
  const std::vector<Feature> features = featuresOf(pieces, clusters);
  // The middle of a cluster: its piece that is nearest to the mean.
  std::vector<std::pair<float, std::uint32_t>> middle(clusters.size(), {kInfinity, scene::kNone});
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    auto& m = middle[clusters.of[i]];
    m = std::min(m, {squaredDistance(features[i], clusters.centre[clusters.of[i]]), i});
  }
  const Nearest nearest(clusters.centre);
  std::vector<std::uint32_t> of(pieces.size(), scene::kNone);
  parallelFor(pieces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::array<Nearest::Found, kCandidates> found;
      const std::size_t count = nearest.find(features[i], found);
      for (std::size_t k = 0; k < count && of[i] == scene::kNone; ++k) {
        // Not round an edge, where the view over it tells nothing.
        const Feature& c = clusters.centre[found[k].index];
        const Vec3 n = Vec3(c[3], c[4], c[5]) / clusters.normal_length;
        if (glm::dot(n, pieces[i].normal) < 0.7f * glm::length(n)) continue;
        if (views.seen(i, middle[found[k].index].second)) of[i] = found[k].index;
      }
    }
  });
  progress.throwIfCancelled();
  // What sees no middle: parts of what was its cluster.
  std::vector<std::vector<std::uint32_t>> left(clusters.size());
  for (std::uint32_t i = 0; i < pieces.size(); ++i)
    if (of[i] == scene::kNone) left[clusters.of[i]].push_back(i);
  auto next = static_cast<std::uint32_t>(clusters.size());
  for (std::vector<std::uint32_t>& rest : left)
    for (int part = 1; !rest.empty(); ++part) {
      const std::uint32_t first = rest[0];
      std::erase_if(rest, [&](std::uint32_t i) {
        if (part < kMostParts && i != first && !views.seen(first, i)) return false;
        of[i] = next;
        return true;
      });
      ++next;
    }
  clusters.of = std::move(of);
  renumber(pieces, features, clusters);
}

}  // namespace relume::transport
