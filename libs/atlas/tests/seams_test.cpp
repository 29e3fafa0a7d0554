// SPDX-License-Identifier: MIT
// findSeams and stitchSeams on scenes whose seams are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "relume/atlas/texels.h"
#include "relume/core/parallel.h"
#include "texels_scene.h"

namespace relume::atlas {
namespace {

using testing::HandMade;

std::vector<SeamSample> seamsOf(const HandMade& made) {
  SilentProgress progress;
  return findSeams(made.scene, made.atlas, progress);
}

/// Value of a side when every texel holds f(page position of its centre).
template <class F>
float lookUp(const SeamSample& s, int side, int width, const F& f) {
  float sum = 0;
  for (int k = 0; k < 4; ++k) {
    const auto t = static_cast<int>(s.texel[side][k]);
    sum += s.weight[side][k] *
           f(Vec2(static_cast<float>(t % width) + 0.5f, static_cast<float>(t / width) + 0.5f));
  }
  return sum;
}
/// Page position that a side looks up: bilinear interpolation of positions.
Vec2 placeOf(const SeamSample& s, int side, int width) {
  return {lookUp(s, side, width, [](Vec2 p) { return p.x; }),
          lookUp(s, side, width, [](Vec2 p) { return p.y; })};
}

/// The floor [0, 2] x [0, 1], two quads of one mesh that share the edge x = 1, each with its own chart of 10
/// x 10 texels; the second one turned by 90 degrees on the page.
HandMade twoCharts() {
  HandMade made(32);
  made.add(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}},
      {{2, 2}, {12, 2}, {12, 12}, {2, 12}, {28.5f, 3.25f}, {28.5f, 13.25f}, {18.5f, 13.25f}, {18.5f, 3.25f}},
      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, {0, 0, 1, 1});
  return made;
}
/// World position of a page position of either chart.
Vec2 worldOf(Vec2 page) {
  if (page.x < 15) return (page - 2.0f) / 10.0f;
  return {1 + (page.y - 3.25f) / 10, (28.5f - page.x) / 10};
}

TEST(FindSeams, BothSidesLookUpTheSamePlace) {
  const auto seams = seamsOf(twoCharts());
  ASSERT_EQ(seams.size(), 10u) << "one for each texel of the edge";
  for (const SeamSample& s : seams) {
    const Vec2 a = worldOf(placeOf(s, 0, 32)), b = worldOf(placeOf(s, 1, 32));
    EXPECT_NEAR(a.x, 1, 1e-5f);
    EXPECT_NEAR(glm::length(a - b), 0, 1e-5f);
    for (int side = 0; side < 2; ++side) {
      EXPECT_NEAR(s.weight[side][0] + s.weight[side][1] + s.weight[side][2] + s.weight[side][3], 1, 1e-6f);
    }
  }
}

TEST(FindSeams, ACreaseIsNoSeamABendIs) {
  for (const float angle : {0.0f, 0.3f, 0.4f, 1.5707963f, 3.1f}) {
    HandMade made(32);
    const Vec3 up(std::cos(angle), 0, std::sin(angle));
    made.addQuad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 2}, {8, 8});
    made.addQuad({1, 0, 0}, up, {0, 1, 0}, {16, 2}, {8, 8});
    EXPECT_EQ(seamsOf(made).size(), angle < 0.349f ? 8u : 0u) << angle;
  }
}

TEST(FindSeams, ShadingNormalsDecide) {
  // A fold of 40 degrees with smooth normals across it is one surface.
  HandMade made(32);
  const float angle = 0.7f;
  const Vec3 up(std::cos(angle), 0, std::sin(angle));
  const Normal middle(-std::sin(angle / 2), 0, std::cos(angle / 2));
  for (int side = 0; side < 2; ++side) {
    scene::Mesh& mesh = side == 0 ? made.addQuad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 2}, {8, 8})
                                  : made.addQuad({1, 0, 0}, up, {0, 1, 0}, {16, 2}, {8, 8});
    mesh.flat_normals = false;
    const std::size_t at[2] = {side == 0 ? 1u : 0u, side == 0 ? 2u : 3u};
    if (side == 1) mesh.normals.assign(4, Normal(-std::sin(angle), 0, std::cos(angle)));
    for (const std::size_t v : at) mesh.normals[v] = middle;
  }
  EXPECT_EQ(seamsOf(made).size(), 8u);
}

TEST(FindSeams, BetweenObjectsOfAKit) {
  // The same tile twice, placed by transforms whose rounding differs, far from the origin; the second one
  // upside down on the page.
  HandMade made(64, 2);
  made.addQuad({0, 0, 0}, {0.7f, 0, 0}, {0, 0, -0.7f}, {3.5f, 4.5f}, {14, 14});
  made.addQuad({0, 0, 0}, {-0.7f, 0, 0}, {0, 0, 0.7f}, {5, 5}, {14, 14}, 1);
  made.scene.instances[0].world_from_local[3] = Vec4(300.1f, 7.3f, -20.9f, 1);
  made.scene.instances[1].world_from_local[3] = Vec4(300.1f + 0.7f + 0.7f, 7.3f, -20.9f - 0.7f, 1);
  const auto seams = seamsOf(made);
  ASSERT_EQ(seams.size(), 14u);
  for (const SeamSample& s : seams) {
    const int first = s.texel[0][0] < 64 * 64 ? 0 : 1;  // which side is on page 0
    const Vec2 a = placeOf(s, first, 64), b = placeOf(s, 1 - first, 64) - Vec2(0, 64);
    EXPECT_NEAR(a.x, 17.5f, 1e-4f);
    EXPECT_NEAR(b.x, 19.0f, 1e-3f);
    EXPECT_NEAR((a.y - 4.5f) + (b.y - 5.0f), 14.0f, 1e-2f);
  }
}

TEST(FindSeams, TJunctionsAndStaggeredTiles) {
  // One long edge of 12 texels against tiles of 5, 5 and 5 that begin 1 texel later and end 4 after it: 5 + 5
  // + 1 in common.
  HandMade made(64);
  made.addQuad({0, 0, 0}, {12, 0, 0}, {0, 1, 0}, {2, 2}, {12, 1});
  for (int i = 0; i < 3; ++i) {
    const float x = 1 + 5 * static_cast<float>(i);
    made.addQuad({x, -1, 0}, {5, 0, 0}, {0, 1, 0}, {20 + 8 * static_cast<float>(i), 2.5f}, {5, 1});
  }
  const auto seams = seamsOf(made);
  // Also the two edges x = 6 and x = 11 between the tiles, a texel each.
  EXPECT_EQ(seams.size(), 11u + 2);
  int with_long = 0;
  for (const SeamSample& s : seams) {
    const Vec2 a = placeOf(s, 0, 64), b = placeOf(s, 1, 64);
    const Vec2 lo = a.x < b.x ? a : b, hi = a.x < b.x ? b : a;
    if (lo.x > 15) continue;
    ++with_long;
    const float tile = std::floor((hi.x - 20) / 8);
    EXPECT_NEAR(lo.x - 2, 1 + 5 * tile + (hi.x - 20 - 8 * tile), 1e-4f);
    EXPECT_NEAR(lo.y, 2, 1e-5f);
    EXPECT_NEAR(hi.y, 3.5f, 1e-5f);
  }
  EXPECT_EQ(with_long, 11);
}

TEST(FindSeams, WhatIsNear) {
  // Gap against tolerance: 1/1000 of a texel is a seam, half a texel is not.
  for (const float gap : {0.001f, 0.5f}) {
    HandMade made(32);
    made.addQuad({0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {2, 2}, {8, 8});
    made.addQuad({8 + gap, 0, 0}, {8, 0, 0}, {0, 8, 0}, {20, 2}, {8, 8});
    EXPECT_EQ(seamsOf(made).size(), gap < 0.1f ? 8u : 0u) << gap;
  }
  // Crossing and touching edges are none.
  HandMade made(32);
  made.addQuad({0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {2, 2}, {8, 8});
  made.addQuad({8, 8, 0}, {8, 0, 0}, {0, 8, 0}, {20, 2}, {8, 8});
  EXPECT_EQ(seamsOf(made).size(), 0u);
}

TEST(FindSeams, AVertexSplitInsideAChartIsNone) {
  // Two triangles of one chart with their own vertices, but the same place on the page: nothing to stitch.
  HandMade made(16);
  made.add({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}},
           {{2, 2}, {9, 2}, {9, 9}, {2, 2}, {9, 9}, {2, 9}}, {{0, 1, 2}, {3, 4, 5}}, {0, 0});
  EXPECT_EQ(seamsOf(made).size(), 0u);
}

TEST(FindSeams, ACutTubeMeetsItself) {
  // One chart around a tube of 64 sides: its first and last column coincide in space.
  HandMade made(128);
  std::vector<Point> positions;
  std::vector<Vec2> uv;
  std::vector<UVec3> triangles;
  for (std::uint32_t i = 0; i <= 64; ++i) {
    const float angle = 2 * kPi * static_cast<float>(i % 64) / 64;
    for (std::uint32_t j = 0; j < 2; ++j) {
      positions.push_back({std::cos(angle), std::sin(angle), static_cast<float>(j)});
      uv.push_back({3 + static_cast<float>(i), 3 + 10 * static_cast<float>(j)});
    }
    if (i < 64)
      triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3}), triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  made.add(positions, uv, triangles, std::vector<std::uint32_t>(triangles.size(), 0));
  const auto seams = seamsOf(made);
  ASSERT_EQ(seams.size(), 10u);
  for (const SeamSample& s : seams) {
    EXPECT_NEAR(std::abs(placeOf(s, 0, 128).x - placeOf(s, 1, 128).x), 64, 1e-4f);
    EXPECT_NEAR(placeOf(s, 0, 128).y, placeOf(s, 1, 128).y, 1e-4f);
  }
}

TEST(FindSeams, ManyTilesOfManySizesAgainstASlowReference) {
  // A floor of random splits: the length of all common edges is known from the rectangles.
  struct Rect {
    float x0, y0, x1, y1;
  };
  std::vector<Rect> rects{{0, 0, 64, 64}};
  std::uint32_t state = 12345;
  const auto next = [&] { return state = state * 1664525u + 1013904223u, state >> 16; };
  while (rects.size() < 200) {
    const std::size_t i = next() % rects.size();
    Rect& r = rects[i];
    const bool in_x = r.x1 - r.x0 > r.y1 - r.y0;
    const float size = in_x ? r.x1 - r.x0 : r.y1 - r.y0;
    if (size < 2) continue;
    const float at = std::floor(size * (0.2f + 0.6f * static_cast<float>(next() % 1000) / 1000));
    if (at < 1) continue;
    Rect other = r;
    if (in_x)
      other.x0 = r.x1 = r.x0 + at;
    else
      other.y0 = r.y1 = r.y0 + at;
    rects.push_back(other);
  }
  HandMade made(512);
  float x = 2, y = 2;
  for (const Rect& r : rects) {
    if (x + r.x1 - r.x0 > 500) x = 2, y += 40;
    made.addQuad({r.x0, r.y0, 0}, {r.x1 - r.x0, 0, 0}, {0, r.y1 - r.y0, 0}, {x, y},
                 {r.x1 - r.x0, r.y1 - r.y0});
    x += r.x1 - r.x0 + 3;
  }
  double common = 0;
  for (std::size_t i = 0; i < rects.size(); ++i) {
    for (std::size_t j = 0; j < rects.size(); ++j) {
      const Rect &a = rects[i], &b = rects[j];
      if (a.x1 == b.x0)
        common += static_cast<double>(std::max(0.0f, std::min(a.y1, b.y1) - std::max(a.y0, b.y0)));
      if (a.y1 == b.y0)
        common += static_cast<double>(std::max(0.0f, std::min(a.x1, b.x1) - std::max(a.x0, b.x0)));
    }
  }
  EXPECT_EQ(static_cast<double>(seamsOf(made).size()), common);
}

TEST(FindSeams, TheSameForAnyNumberOfThreads) {
  HandMade made(512);
  for (int i = 0; i < 400; ++i) {
    const float x = static_cast<float>(i % 20), y = static_cast<float>(i / 20);
    made.addQuad({x, y, 0}, {1, 0, 0}, {0, 1, 0}, {2 + 9 * x, 2 + 9 * y}, {7, 7});
  }
  std::vector<SeamSample> one, many;
  {
    const ThreadLimit limit(1);
    one = seamsOf(made);
  }
  many = seamsOf(made);
  ASSERT_EQ(one.size(), 2u * 20 * 19 * 7);
  ASSERT_EQ(one.size(), many.size());
  EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(SeamSample)), 0);
}

/// Largest difference of the two sides of any seam sample.
float worstStep(const std::vector<SeamSample>& seams, const std::vector<float>& values, int channels = 1,
                int channel = 0) {
  float worst = 0;
  for (const SeamSample& s : seams) {
    float difference = 0;
    for (int k = 0; k < 8; ++k) {
      const float v = values[s.texel[k / 4][k % 4] * static_cast<std::size_t>(channels) +
                             static_cast<std::size_t>(channel)];
      difference += (k < 4 ? 1.0f : -1.0f) * s.weight[k / 4][k % 4] * v;
    }
    worst = std::max(worst, std::abs(difference));
  }
  return worst;
}

TEST(StitchSeams, TakesTheStepOutOfARamp) {
  // Channel 0: a ramp along the seam, 0.2 higher on the second chart. Channel 1: the ramp without a step,
  // which must stay.
  const auto seams = seamsOf(twoCharts());
  std::vector<float> values(32 * 32 * 2);
  for (int t = 0; t < 32 * 32; ++t) {
    const Vec2 page(static_cast<float>(t % 32) + 0.5f, static_cast<float>(t / 32) + 0.5f);
    const float ramp = 0.3f + 0.2f * worldOf(page).y;
    values[static_cast<std::size_t>(2 * t)] = ramp + (page.x > 15 ? 0.2f : 0.0f);
    values[static_cast<std::size_t>(2 * t + 1)] = ramp;
  }
  const std::vector<float> before = values;
  stitchSeams(seams, 2, values);
  EXPECT_NEAR(worstStep(seams, before, 2), 0.2f, 1e-5f);
  EXPECT_LT(worstStep(seams, values, 2), 0.02f);
  std::vector<int> touched(32 * 32, 0);
  for (const SeamSample& s : seams) {
    for (int k = 0; k < 8; ++k) touched[s.texel[k / 4][k % 4]] |= s.weight[k / 4][k % 4] > 0;
  }
  for (std::size_t t = 0; t < 32 * 32; ++t) {
    EXPECT_NEAR(values[2 * t + 1], before[2 * t + 1], 1e-6f);
    if (!touched[t]) {
      EXPECT_EQ(values[2 * t], before[2 * t]);
    }
    EXPECT_LE(std::abs(values[2 * t] - before[2 * t]), 0.2f);
  }
}

TEST(StitchSeams, SolvesTheLeastSquaresProblem) {
  // Against dense elimination of the normal equations, random values.
  const auto seams = seamsOf(twoCharts());
  std::vector<float> values(32 * 32);
  std::uint32_t state = 7;
  for (float& v : values) v = static_cast<float>((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f;
  const std::vector<float> original = values;
  const float fidelity = 0.5f;
  stitchSeams(seams, 1, values, fidelity);

  std::vector<std::size_t> texels;
  for (const SeamSample& s : seams) {
    for (int k = 0; k < 8; ++k) {
      if (s.weight[k / 4][k % 4] > 0) texels.push_back(s.texel[k / 4][k % 4]);
    }
  }
  std::sort(texels.begin(), texels.end());
  texels.erase(std::unique(texels.begin(), texels.end()), texels.end());
  const std::size_t n = texels.size();
  std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0.0));
  for (std::size_t i = 0; i < n; ++i)
    a[i][i] = static_cast<double>(fidelity), a[i][n] = static_cast<double>(fidelity * original[texels[i]]);
  for (const SeamSample& s : seams) {
    std::vector<double> row(n, 0.0);
    for (int k = 0; k < 8; ++k) {
      if (s.weight[k / 4][k % 4] == 0) continue;
      const auto i = std::lower_bound(texels.begin(), texels.end(), s.texel[k / 4][k % 4]) - texels.begin();
      row[static_cast<std::size_t>(i)] += (k < 4 ? 1.0 : -1.0) * static_cast<double>(s.weight[k / 4][k % 4]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) a[i][j] += row[i] * row[j];
    }
  }
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t i = 0; i < n; ++i) {
      if (i == p) continue;
      const double f = a[i][p] / a[p][p];
      for (std::size_t j = p; j <= n; ++j) a[i][j] -= f * a[p][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    float lo = 1, hi = 0;  // of what the texel's samples look up
    for (const SeamSample& s : seams) {
      bool mine = false;
      for (int k = 0; k < 8; ++k) mine |= s.texel[k / 4][k % 4] == texels[i] && s.weight[k / 4][k % 4] > 0;
      for (int k = 0; k < 8 && mine; ++k) {
        if (s.weight[k / 4][k % 4] == 0) continue;
        lo = std::min(lo, original[s.texel[k / 4][k % 4]]);
        hi = std::max(hi, original[s.texel[k / 4][k % 4]]);
      }
    }
    EXPECT_NEAR(values[texels[i]], std::clamp(static_cast<float>(a[i][n] / a[i][i]), lo, hi), 1e-4f);
  }
}

TEST(StitchSeams, NeverLeavesTheRangeOfTheValues) {
  const auto seams = seamsOf(twoCharts());
  std::vector<float> values(32 * 32);
  std::uint32_t state = 99;
  for (float& v : values) v = (state = state * 1664525u + 1013904223u) >> 31 ? 1.0f : 0.0f;
  stitchSeams(seams, 1, values, 1e-3f);
  for (const float v : values) {
    EXPECT_GE(v, 0.0f);
    EXPECT_LE(v, 1.0f);
  }
}

TEST(StitchSeams, UncoveredTexelsFollowTheCovered) {
  // Chart 1 is all made up (buried): most of the step is taken there.
  const auto seams = seamsOf(twoCharts());
  std::vector<float> values(32 * 32);
  std::vector<std::uint8_t> covered(32 * 32);
  for (std::size_t t = 0; t < values.size(); ++t)
    covered[t] = t % 32 < 15, values[t] = covered[t] ? 0.3f : 0.8f;
  const std::vector<float> before = values;
  stitchSeams(seams, 1, values, 0.1f, covered);
  EXPECT_LT(worstStep(seams, values), 0.05f);
  float moved[2] = {0, 0};
  for (std::size_t t = 0; t < values.size(); ++t) {
    moved[covered[t]] = std::max(moved[covered[t]], std::abs(values[t] - before[t]));
  }
  EXPECT_LT(2.5f * moved[1], moved[0]);
}

TEST(StitchSeams, NothingToDo) {
  std::vector<float> values{1, 2, 3};
  stitchSeams({}, 1, values);
  EXPECT_EQ(values, (std::vector<float>{1, 2, 3}));
}

TEST(StitchSeams, TheSameForAnyNumberOfThreads) {
  HandMade made(512);
  for (int i = 0; i < 2500; ++i) {
    const float x = static_cast<float>(i % 50), y = static_cast<float>(i / 50);
    made.addQuad({x, y, 0}, {1, 0, 0}, {0, 1, 0}, {2 + 9 * x, 2.3f + 9 * y}, {7, 7});
  }
  const auto seams = seamsOf(made);
  std::vector<float> one(512 * 512 * 3), many;
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = static_cast<float>(i * 7919 % 1000) / 1000;
  many = one;
  {
    const ThreadLimit limit(1);
    stitchSeams(seams, 3, one);
  }
  stitchSeams(seams, 3, many);
  EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(float)), 0);
}

}  // namespace
}  // namespace relume::atlas
