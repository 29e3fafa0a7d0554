// SPDX-License-Identifier: MIT
#include "relume/core/kmeans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume {
namespace {

std::vector<float> squarePoints(std::size_t count) {
  std::vector<float> features;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec2 p = sobol2(i, 5);
    features.insert(features.end(), {p.x, p.y});
  }
  return features;
}

TEST(KMeans, PartsClustersThatLieApart) {
  // Four heaps, of different size, at the corners of a square of side 10.
  std::vector<float> features;
  std::vector<std::uint32_t> heap;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const std::uint32_t h = i % 10 < 7 ? 0 : 1 + i % 3;
    const Vec2 p = sobol2(i, 3);
    features.insert(features.end(), {p.x + (h & 1 ? 10.0f : 0.0f), p.y + (h & 2 ? 10.0f : 0.0f)});
    heap.push_back(h);
  }
  const KMeans k = kMeans(features, 2, {}, {.clusters = 4});
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t i = 0; i < heap.size(); ++i) pairs.insert({heap[i], k.label[i]});
  EXPECT_EQ(pairs.size(), 4u);
}

TEST(KMeans, EndsWhereLloydStandsStill) {
  const std::vector<float> features = squarePoints(2000);
  std::vector<float> weights;
  for (std::size_t i = 0; i < 2000; ++i) weights.push_back(1.0f + static_cast<float>(i % 7));
  const KMeans k = kMeans(features, 2, weights, {.clusters = 20, .iterations = 500});
  std::vector<double> sum(40), total(20);
  for (std::size_t i = 0; i < 2000; ++i) {
    double nearest = 1e9, own = 0;
    for (std::size_t c = 0; c < 20; ++c) {
      const double d =
          std::hypot(features[2 * i] - k.centre[2 * c], features[2 * i + 1] - k.centre[2 * c + 1]);
      nearest = std::min(nearest, d);
      if (c == k.label[i]) own = d;
    }
    EXPECT_LE(own, nearest + 1e-6);
    total[k.label[i]] += weights[i];
    for (std::size_t d = 0; d < 2; ++d)
      sum[2 * k.label[i] + d] += static_cast<double>(weights[i]) * features[2 * i + d];
  }
  for (std::size_t j = 0; j < 40; ++j) EXPECT_NEAR(k.centre[j], sum[j] / total[j / 2], 1e-6);
}

TEST(KMeans, BlueNoiseOfTheSquareIsNearTheBestPossible) {
  // Hexagons of area 1/64 have a second moment of 5 / (18 sqrt 3) area^2 = 0.1604 area^2: no 64 cells can do
  // better (Fejes Toth). Lloyd's cells come within 10 %.
  const std::vector<float> features = squarePoints(16384);
  const KMeans k = kMeans(features, 2, {}, {.clusters = 64, .iterations = 200});
  double sum = 0;
  for (std::size_t i = 0; i < 16384; ++i)
    for (std::size_t d = 0; d < 2; ++d)
      sum += std::pow(features[2 * i + d] - k.centre[2 * k.label[i] + d], 2.0) / 16384;
  const double best = 5.0 / (18.0 * std::sqrt(3.0)) / 64.0;
  EXPECT_GT(sum, 0.99 * best);
  EXPECT_LT(sum, 1.10 * best);
}

TEST(KMeans, WeightsDrawCentres) {
  // One heavy point among light ones: its cluster's centre is at the point.
  const std::vector<float> features = {0, 1, 2, 3, 100};
  const KMeans k = kMeans(features, 1, std::vector<float>{1, 1, 1e6f, 1, 1}, {.clusters = 2});
  EXPECT_NEAR(k.centre[k.label[2]], 2.0f, 1e-4f);
  EXPECT_EQ(k.centre[k.label[4]], 100.0f);
}

TEST(KMeans, NoClusterIsEmpty) {
  // More clusters than places, and more than points.
  std::vector<float> features(30, 1.0f);
  features[7] = 2.0f;
  const KMeans k = kMeans(features, 1, {}, {.clusters = 5});
  std::vector<std::uint32_t> labels = k.label;
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  EXPECT_EQ(labels.size(), 5u);
  EXPECT_EQ(kMeans(std::vector<float>{1, 2, 3}, 1, {}, {.clusters = 9}).clusters, 3u);
  EXPECT_EQ(kMeans({}, 3, {}).clusters, 0u);
  EXPECT_EQ(kMeans(std::vector<float>{4}, 1, {}, {.clusters = 1}).centre[0], 4.0f);
}

TEST(KMeans, SameBitsForAnyNumberOfThreads) {
  const std::vector<float> features = squarePoints(3000);
  const KMeans many = kMeans(features, 2, {}, {.clusters = 40});
  const ThreadLimit one(1);
  const KMeans single = kMeans(features, 2, {}, {.clusters = 40});
  EXPECT_EQ(many.label, single.label);
  EXPECT_EQ(many.centre, single.centre);
}

}  // namespace
}  // namespace relume
