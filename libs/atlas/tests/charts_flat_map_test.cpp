// SPDX-License-Identifier: MIT
#include "charts/flat_map.h"

#include <gtest/gtest.h>

#include <numeric>

#include "charts/box.h"
#include "charts/overlap.h"
#include "charts_meshes.h"

namespace relume::atlas {
namespace {

using namespace test;

ChartMesh wholeMesh(const Topology& topology) {
  std::vector<std::uint32_t> all(topology.triangleCount());
  std::iota(all.begin(), all.end(), 0u);
  return ChartMeshBuilder(topology).build(all);
}

// A cap of angle a, seen from above: singular values are 1 and 1 / cos t at angle t, and the plane's area is
// sin^2 a / (2 (1 - cos a)) of the surface's. The integral gives L2^2 = (1 + cos a)^2 / (4 cos a), Linf^2 =
// (1 + cos a) / (2 cos^2 a).
TEST(ChartsFlatMap, StretchOfAProjectedCapIsTheClosedForm) {
  const double a = kPi / 3;
  const scene::Mesh mesh = sheet("cap", 200, 400, [&](float u, float v) {
    const Vec2 c = onCircle(u);
    const float t = 0.004f + (static_cast<float>(a) - 0.004f) * v;
    return Point(std::sin(t) * c.x, std::sin(t) * c.y, -std::cos(t));
  });
  const Topology topology = connect(mesh, Mat3(1.0f));
  ChartMesh chart = wholeMesh(topology);
  projectToPlane(topology, chart);
  ASSERT_TRUE(normalizeAndMeasure(topology, chart));
  EXPECT_NEAR(chart.mean_stretch, (1 + std::cos(a)) / (2 * std::sqrt(std::cos(a))), 1e-3);
  EXPECT_NEAR(chart.max_stretch, std::sqrt(0.5 * (1 + std::cos(a))) / std::cos(a), 1e-2);
}

// A cylinder unrolls without stretch: half of it starts from its projection, whose stretch is without bound
// at the rims.
TEST(ChartsFlatMap, DevelopableSurfacesUnroll) {
  const scene::Mesh mesh = cylinder(32, 8, 0.5f, 2, 0.4f);
  const Topology topology = connect(mesh, Mat3(1.0f));
  ChartMesh chart = wholeMesh(topology);
  projectToPlane(topology, chart);
  ASSERT_TRUE(normalizeAndMeasure(topology, chart));
  EXPECT_GT(chart.mean_stretch, 1.1);
  relaxMap(topology, chart, 30);
  ASSERT_TRUE(normalizeAndMeasure(topology, chart));
  EXPECT_LT(chart.mean_stretch, 1.001);
  EXPECT_LT(chart.max_stretch, 1.01);
  const DVec2 extent = boxOf(chart).extent();
  EXPECT_NEAR(extent.x, 2.0, 0.01);
  EXPECT_NEAR(extent.y, 0.4 * 2 * kPi * 0.5, 0.02);
}

TEST(ChartsFlatMap, RelaxingKeepsEveryTriangleUpright) {
  const scene::Mesh mesh = sheet("spike", 24, 24, [](float u, float v) {
    const float r2 = (u - 0.5f) * (u - 0.5f) + (v - 0.5f) * (v - 0.5f);
    return Point(u, -v, 0.8f * std::exp(-60 * r2));
  });
  const Topology topology = connect(mesh, Mat3(1.0f));
  ChartMesh chart = wholeMesh(topology);
  projectToPlane(topology, chart);
  ASSERT_TRUE(normalizeAndMeasure(topology, chart));
  const double before = chart.mean_stretch;
  for (int i = 0; i < 5; ++i) {
    relaxMap(topology, chart, 2);
    ASSERT_TRUE(measureStretch(topology, chart).valid);
  }
  ASSERT_TRUE(normalizeAndMeasure(topology, chart));
  EXPECT_LT(chart.mean_stretch, before);
}

TEST(ChartsFlatMap, SmallestBoxOfATurnedRectangle) {
  std::vector<DVec2> points;
  const DVec2 x(std::cos(0.7), std::sin(0.7)), y(-x.y, x.x);
  for (const DVec2 p : {DVec2(0, 0), DVec2(1, 0), DVec2(1, 3), DVec2(0, 3), DVec2(0.5, 1.5)})
    points.push_back(p.x * x + p.y * y);
  const OrientedBox box = smallestBox(points);
  EXPECT_NEAR(box.extent().x, 3, 1e-12);
  EXPECT_NEAR(box.extent().y, 1, 1e-12);
  for (const DVec2 p : points) {
    const DVec2 q = box.toBox(p) - box.lo;
    EXPECT_TRUE(q.x > -1e-12 && q.y > -1e-12 && q.x < 3 + 1e-12 && q.y < 1 + 1e-12);
  }
  EXPECT_NEAR(smallestBox({DVec2(1, 2)}).extent().x, 0, 1e-12);
}

TEST(ChartsOverlap, ARibbonThatWindsTwiceOverlaps) {
  const scene::Mesh topology_mesh = helix();
  const Topology topology = connect(topology_mesh, Mat3(1.0f));
  ChartMesh chart = wholeMesh(topology);
  projectToPlane(topology, chart);
  ASSERT_TRUE(normalizeAndMeasure(topology, chart));
  EXPECT_TRUE(overlapsItself(chart));
}

TEST(ChartsOverlap, HolesAndHollowsDoNot) {
  for (const scene::Mesh& mesh : {frame(), grid(), cylinder(16, 4, 0.5f, 2, 0.45f), bumps(24)}) {
    const Topology topology = connect(mesh, Mat3(1.0f));
    ChartMesh chart = wholeMesh(topology);
    projectToPlane(topology, chart);
    ASSERT_TRUE(normalizeAndMeasure(topology, chart));
    EXPECT_FALSE(overlapsItself(chart)) << mesh.name;
  }
}

// Two sheets exactly on each other, joined along one side into one chart: their borders cross nowhere, only
// the winding tells.
TEST(ChartsOverlap, SheetsOnEachOtherOverlap) {
  ChartMesh chart;
  chart.uv = {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}};
  chart.corners = {{0, 1, 2}, {3, 4, 5}};
  chart.triangles = {0, 1};
  chart.border = {0, 1, 2, 3, 4, 5};
  EXPECT_TRUE(overlapsItself(chart));
  for (std::size_t v = 3; v < 6; ++v) chart.uv[v].x += 1.0;
  EXPECT_FALSE(overlapsItself(chart));
}

TEST(ChartsOverlap, WindingCountsSheets) {
  const SegmentBands once({{{0, 0}, {4, 0}}, {{4, 0}, {4, 4}}, {{4, 4}, {0, 4}}, {{0, 4}, {0, 0}}});
  EXPECT_EQ(once.winding({1, 1}), 1);
  EXPECT_EQ(once.winding({5, 1}), 0);
  EXPECT_EQ(once.winding({1, -1}), 0);
  const SegmentBands with_hole({{{0, 0}, {4, 0}},
                                {{4, 0}, {4, 4}},
                                {{4, 4}, {0, 4}},
                                {{0, 4}, {0, 0}},
                                {{1, 1}, {1, 2}},
                                {{1, 2}, {2, 2}},
                                {{2, 2}, {2, 1}},
                                {{2, 1}, {1, 1}}});
  EXPECT_EQ(with_hole.winding({1.5, 1.5}), 0);
  EXPECT_EQ(with_hole.winding({3, 3}), 1);
}

// A T-junction that rounding pushed over the edge by 0.001.
TEST(ChartsOverlap, SlitsAreClosed) {
  ChartMesh chart;
  chart.uv = {{0, 0}, {2, 0}, {1, -1}, {0, 0.5}, {1, -0.001}, {2, 0.5}};
  chart.corners = {{0, 2, 1}, {3, 4, 5}};
  chart.triangles = {0, 1};
  chart.border = {0, 1, 2, 3, 4, 5};
  closeSlits(chart, 0.01);
  EXPECT_NEAR(chart.uv[4].y, 0, 1e-12);
  EXPECT_EQ(chart.uv[3], DVec2(0, 0.5));
}

}  // namespace
}  // namespace relume::atlas
