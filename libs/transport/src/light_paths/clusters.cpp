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
std::vector<Feature> firstCentres(std::span<const Piece> pieces, std::span<const double> weights,
                                  std::span<const Feature> features, std::size_t count, std::uint64_t seed) {
  double so_far = 0;
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double offset = static_cast<double>(sobol2(0, streamOf(seed, 0, 0)).x);
  std::vector<Feature> centres;
  for (const std::uint32_t i : inOrder(pieces)) {
    so_far += weights[i];
    if (so_far >= (static_cast<double>(centres.size()) + offset) * all / static_cast<double>(count) &&
        centres.size() < count)
      centres.push_back(features[i]);
  }
  if (centres.empty()) centres.push_back(features[0]);
  return centres;
}

/// Means of clusters. Those that have no piece become the worst placed pieces.
void moveCentres(std::span<const double> weights, std::span<const Feature> features,
                 std::span<const std::uint32_t> of, std::vector<Feature>& centres) {
  std::vector<std::array<double, 6>> sum(centres.size(), std::array<double, 6>{});
  std::vector<double> weight(centres.size(), 0.0);
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (of[i] == scene::kNone) continue;
    weight[of[i]] += weights[i];
    for (std::size_t a = 0; a < 6; ++a) sum[of[i]][a] += weights[i] * static_cast<double>(features[i][a]);
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
  std::vector<std::pair<double, std::uint32_t>> worst(features.size());
  for (std::uint32_t i = 0; i < features.size(); ++i)
    worst[i] = {-weights[i] * static_cast<double>(squaredDistance(features[i], centres[of[i]])), i};
  const std::size_t some = std::min(empty.size(), worst.size());
  std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(some), worst.end());
  for (std::size_t k = 0; k < some; ++k) centres[empty[k]] = features[worst[k].second];
}

/// Numbers clusters without gaps and takes their means.
void renumber(std::span<const double> weights, std::span<const Feature> features, Clusters& clusters) {
  std::vector<std::uint32_t> number(clusters.of.size() + clusters.size(), scene::kNone);
  for (const std::uint32_t c : clusters.of)
    if (c != scene::kNone) number[c] = 0;
  std::uint32_t count = 0;
  for (std::uint32_t& n : number)
    if (n == 0) n = count++;
  for (std::uint32_t& c : clusters.of)
    if (c != scene::kNone) c = number[c];
  clusters.centre.assign(count, Feature{});
  moveCentres(weights, features, clusters.of, clusters.centre);
}

std::vector<Feature> featuresOf(std::span<const Piece> pieces, const Clusters& clusters) {
  std::vector<Feature> features;
  features.reserve(pieces.size());
  for (const Piece& p : pieces) features.push_back(clusters.feature(p.position, p.normal));
  return features;
}

std::vector<double> weightsOf(std::span<const Piece> pieces, std::span<const float> importance) {
  std::vector<double> weights;
  weights.reserve(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i)
    weights.push_back(std::max(static_cast<double>(pieces[i].area * importance[i]), 1e-30));
  return weights;
}

/// Of a square that is one of `count` equal parts.
float sideOf(std::span<const double> weights, std::size_t count) {
  return static_cast<float>(std::sqrt(std::accumulate(weights.begin(), weights.end(), 0.0) /
                                      static_cast<double>(std::max<std::size_t>(count, 1))));
}

}  // namespace

Feature Clusters::feature(Point p, Normal n) const {
  const Vec3 m = normal_length * n;
  return {p.x, p.y, p.z, m.x, m.y, m.z};
}

Clusters makeClusters(std::span<const Piece> pieces, std::span<const float> importance,
                      const ClusterOptions& options, Progress& progress) {
  Clusters clusters;
  if (pieces.empty()) return clusters;
  const std::vector<double> weights = weightsOf(pieces, importance);
  clusters.normal_length = std::max(options.normal_weight * sideOf(weights, options.count), 1e-20f);
  const std::vector<Feature> features = featuresOf(pieces, clusters);
  clusters.centre = firstCentres(pieces, weights, features, options.count, options.seed);
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
    moveCentres(weights, features, clusters.of, clusters.centre);
  }
  renumber(weights, features, clusters);
  return clusters;
}

namespace {

/// From how far above the surface pieces look, in sides of a cluster: over a sill, under a shelf. Seen from
/// either height is seen.
constexpr float kHeights[] = {0.1f, 0.5f};
constexpr std::size_t kCandidates = 8;  // clusters that a piece may go to
constexpr double kSliver = 0.05;        // of the mean weight of clusters: no cluster of its own
constexpr int kMostParts = 4;           // of what is left of a cluster

class Belonging {
 public:
  Belonging(const trace::Tracer& tracer, std::span<const Piece> pieces, const LightView& light, float side)
      : tracer_(tracer), light_(light), places_(pieces.size()) {
    parallelFor(pieces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Point start = trace::offsetOrigin(pieces[i].position, pieces[i].normal);
        const float room = tracer_.intersect({start, pieces[i].normal, kHeights[1] * side}).t;
        for (std::size_t h = 0; h < std::size(kHeights); ++h)
          places_[i][h] = start + std::min(kHeights[h] * side, 0.5f * room) * pieces[i].normal;
      }
    });
  }
  bool together(std::size_t a, std::size_t b) const {
    switch (light_.compare(a, b)) {
      case LightView::Likeness::kAlike:
        return true;
      case LightView::Likeness::kApart:
        return false;
      default:
        return seen(a, b);
    }
  }

 private:
  bool seen(std::size_t a, std::size_t b) const {
    for (std::size_t h = 0; h < std::size(kHeights); ++h) {
      const Vec3 way = places_[b][h] - places_[a][h];
      const float length = glm::length(way);
      if (!(length > 0) || !tracer_.occluded({places_[a][h], way / length, length})) return true;
    }
    return false;
  }

  const trace::Tracer& tracer_;
  const LightView& light_;
  std::vector<std::array<Point, std::size(kHeights)>> places_;
};

}  // namespace

void partByLight(const trace::Tracer& tracer, std::span<const Piece> pieces,
                 std::span<const float> importance, const LightView& light, Slivers slivers,
                 Clusters& clusters, Progress& progress) {
  if (pieces.empty()) return;
  const std::vector<double> weights = weightsOf(pieces, importance);
  const Belonging belonging(tracer, pieces, light, sideOf(weights, clusters.size()));
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
        if (belonging.together(i, middle[found[k].index].second)) of[i] = found[k].index;
      }
    }
  });
  progress.throwIfCancelled();
  // What belongs nowhere: parts of what was its cluster.
  std::vector<std::vector<std::uint32_t>> left(clusters.size());
  for (std::uint32_t i = 0; i < pieces.size(); ++i)
    if (of[i] == scene::kNone) left[clusters.of[i]].push_back(i);
  const double small =
      kSliver * std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(clusters.size());
  auto next = static_cast<std::uint32_t>(clusters.size());
  std::vector<std::uint32_t> part;
  for (std::vector<std::uint32_t>& rest : left)
    for (int number = 1; !rest.empty(); ++number) {
      const std::uint32_t first = rest[0];
      part.clear();
      std::erase_if(rest, [&](std::uint32_t i) {
        if (number < kMostParts && i != first && !belonging.together(first, i)) return false;
        part.push_back(i);
        return true;
      });
      double weight = 0;
      for (const std::uint32_t i : part) weight += weights[i];
      const bool sliver = weight < small;
      bool used = false;
      for (const std::uint32_t i : part) {
        if (sliver && slivers == Slivers::kLeftOutIfDark && light.dark(i)) continue;
        const bool stays =
            sliver && light.compare(i, middle[clusters.of[i]].second) != LightView::Likeness::kApart;
        of[i] = stays ? clusters.of[i] : next;
        used |= !stays;
      }
      next += used;
    }
  clusters.of = std::move(of);
  renumber(weights, features, clusters);
}

Clusters makeLitClusters(const trace::Tracer& tracer, std::span<const Piece> pieces,
                         std::span<const float> importance, const LightView& light,
                         const ClusterOptions& options, Slivers slivers, Progress& progress) {
  Clusters clusters = makeClusters(pieces, importance, options, progress);
  partByLight(tracer, pieces, importance, light, slivers, clusters, progress);
  if (clusters.size() <= options.count + options.count / 8) return clusters;
  ClusterOptions fewer = options;
  fewer.count = std::max<std::size_t>(options.count * options.count / clusters.size(), 1);
  clusters = makeClusters(pieces, importance, fewer, progress);
  partByLight(tracer, pieces, importance, light, slivers, clusters, progress);
  return clusters;
}

}  // namespace relume::transport
