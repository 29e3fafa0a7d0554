// SPDX-License-Identifier: MIT
// Growing, joining and cutting of charts, before packing.
#include "charts/unwrap.h"

#include <gtest/gtest.h>

#include "charts/flatten.h"
#include "charts/grow.h"
#include "charts/join.h"
#include "charts/overlap.h"
#include "charts/split.h"
#include "charts_meshes.h"

namespace relume::atlas {
namespace {

using namespace test;

std::vector<ChartMesh> flatCharts(const Topology& topology, float discontinuity = 1.05f, float cone = 1.2f) {
  SilentProgress progress;
  return flattenClusters(topology, growClusters(topology, discontinuity, cone), 1.1, progress);
}

void expectSound(const Topology& topology, const std::vector<ChartMesh>& charts) {
  std::vector<int> seen(topology.triangleCount(), 0);
  for (const ChartMesh& chart : charts) {
    EXPECT_TRUE(measureStretch(topology, chart).valid);
    EXPECT_FALSE(overlapsItself(chart));
    for (const std::uint32_t t : chart.triangles) ++seen[t];
  }
  for (std::uint32_t t = 0; t < topology.triangleCount(); ++t)
    EXPECT_EQ(seen[t], topology.degenerate(t) ? 0 : 1);
}

TEST(ChartsGrow, CreasesSeparateAndConesBound) {
  const scene::Mesh box_topology_mesh = cube();
  const Topology box_topology = connect(box_topology_mesh, Mat3(1.0f));
  EXPECT_EQ(growClusters(box_topology, 1.05f, 1.2f).roots.size(), 6u);

  const scene::Mesh topology_mesh = icosphere(4);
  const Topology topology = connect(topology_mesh, Mat3(1.0f));
  for (const float cone : {0.5f, 1.2f}) {
    const ClusterForest forest = growClusters(topology, 1.05f, cone);
    std::vector<std::uint32_t> parent(forest.facets + forest.children.size(), kNone);
    for (std::uint32_t i = 0; i < forest.children.size(); ++i) {
      for (const std::uint32_t child : forest.children[i]) parent[child] = forest.facets + i;
    }
    std::map<std::uint32_t, Vec3> axis;
    const auto rootOf = [&](std::uint32_t t) {
      std::uint32_t n = forest.facet[t];
      while (parent[n] != kNone) n = parent[n];
      return n;
    };
    for (std::uint32_t t = 0; t < topology.triangleCount(); ++t)
      axis[rootOf(t)] += topology.area[t] * topology.normal[t];
    float widest = 0;
    for (std::uint32_t t = 0; t < topology.triangleCount(); ++t) {
      widest = std::max(widest, std::acos(glm::dot(glm::normalize(axis[rootOf(t)]), topology.normal[t])));
    }
    EXPECT_LE(widest, cone + 0.1f) << "facets are judged by their bounds, borders are straightened";
    // Caps of that angle cover the sphere a few times at most.
    EXPECT_LE(forest.roots.size(), 4 * 2 / (1 - std::cos(cone)));
    EXPECT_EQ(axis.size(), forest.roots.size());
  }
}

TEST(ChartsFlatten, EveryMadeMeshLiesFlatWithoutOverlap) {
  for (const scene::Mesh& mesh : {grid(), cube(), room(), icosphere(3), torus(), cylinder(), twoSided(),
                                  frame(), helix(), bumps(), soup(200, 3), book()}) {
    SCOPED_TRACE(mesh.name);
    const Topology topology = connect(mesh, Mat3(1.0f));
    std::vector<ChartMesh> charts = flatCharts(topology);
    expectSound(topology, charts);
    for (const double texel : {0.001, 0.05, 1.0}) {
      std::vector<ChartMesh> joined = charts;
      splitHollowCharts(topology, {texel, 2, 256}, joined);
      expectSound(topology, joined);
      joinCharts(topology, {texel, 2, 128 * texel, 1.05f, 1.1}, joined);
      expectSound(topology, joined);
      for (const ChartMesh& chart : joined) EXPECT_LE(chart.mean_stretch, 1.1 + 1e-9);
    }
  }
}

// Two identical sheets that share all edges: the mates pair them into one facet that covers itself.
TEST(ChartsFlatten, DoubledSheetsComeApart) {
  scene::Mesh mesh = grid(6);
  const std::vector<UVec3> once = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  const Topology topology = connect(mesh, Mat3(1.0f));
  const std::vector<ChartMesh> charts = flatCharts(topology);
  expectSound(topology, charts);
  EXPECT_LE(charts.size(), 8u);
}

TEST(ChartsJoin, SmallCubesUnfoldAndLargeOnesDoNot) {
  const scene::Mesh topology_mesh = cube();
  const Topology topology = connect(topology_mesh, Mat3(1.0f));
  const auto joined = [&](double texel) {
    std::vector<ChartMesh> charts = flatCharts(topology);
    joinCharts(topology, {texel, 2, 1000.0, 1.05f, 1.1}, charts);
    expectSound(topology, charts);
    return charts;
  };
  EXPECT_EQ(joined(0.001).size(), 6u) << "sides of 1000 texels keep their creases sharp";
  EXPECT_EQ(joined(1.0 / 13).size(), 6u) << "light would be seen to bleed about an edge of 13 texels";
  const std::vector<ChartMesh> small = joined(0.2);
  EXPECT_LE(small.size(), 3u) << "sides of 5 texels are worth unfolding";
  for (const ChartMesh& chart : small) EXPECT_NEAR(chart.max_stretch, 1, 1e-6);
}

// Nothing that is near in the chart and far in space: the ends of an unfolded strip must not meet again.
TEST(ChartsJoin, SidesOfASheetAreNeverOneChart) {
  const scene::Mesh topology_mesh = twoSided();
  const Topology topology = connect(topology_mesh, Mat3(1.0f));
  std::vector<ChartMesh> charts = flatCharts(topology);
  joinCharts(topology, {0.5, 2, 1000.0, 1.05f, 1.1}, charts);
  EXPECT_EQ(charts.size(), 2u);
}

TEST(ChartsJoin, AThinTubeUnrollsIntoFewStrips) {
  const scene::Mesh topology_mesh = cylinder(24, 40, 0.05f, 2);
  const Topology topology = connect(topology_mesh, Mat3(1.0f));
  std::vector<ChartMesh> charts = flatCharts(topology);
  EXPECT_GE(charts.size(), 3u);
  joinCharts(topology, {0.02, 2, 1000.0, 1.05f, 1.1}, charts);
  expectSound(topology, charts);
  EXPECT_EQ(charts.size(), 1u);
}

TEST(ChartsSplit, LargeFramesAreCutIntoBarsAndSmallOnesKept) {
  const scene::Mesh topology_mesh = frame();
  const Topology topology = connect(topology_mesh, Mat3(1.0f));
  std::vector<ChartMesh> large = flatCharts(topology);
  ASSERT_EQ(large.size(), 1u);
  std::vector<ChartMesh> small = large;
  splitHollowCharts(topology, {0.01, 2, 1024}, large);
  expectSound(topology, large);
  EXPECT_GE(large.size(), 4u);
  joinCharts(topology, {0.01, 2, 512 * 0.01, 1.05f, 1.1}, large);
  expectSound(topology, large);
  EXPECT_EQ(large.size(), 4u) << "what was cut too small joins again, the frame does not";
  splitHollowCharts(topology, {0.4, 2, 1024}, small);
  EXPECT_EQ(small.size(), 1u);
}

TEST(ChartsSplit, NothingIsLongerThanAPage) {
  const scene::Mesh road = sheet("road", 100, 1, [](float u, float v) { return Point(100 * u, 0, -v); });
  const Topology topology = connect(road, Mat3(1.0f));
  std::vector<ChartMesh> charts = flatCharts(topology);
  ASSERT_EQ(charts.size(), 1u);
  splitHollowCharts(topology, {0.1, 2, 256}, charts);
  expectSound(topology, charts);
  EXPECT_GE(charts.size(), 4u);
  EXPECT_LE(charts.size(), 8u);
}

TEST(ChartsUnwrap, VerticesOfACornerAreSplitByChartAndByAttribute) {
  SilentProgress progress;
  UnwrapOptions options;
  options.texel = 0.001;
  const Unwrap result = unwrap(cube(), Mat3(1.0f), options, progress);
  EXPECT_EQ(result.charts.size(), 6u);
  EXPECT_EQ(result.source_vertex.size(), 24u);
  for (const FlatChart& chart : result.charts) {
    EXPECT_NEAR(chart.extent.x, 1, 1e-6);
    EXPECT_NEAR(chart.area, 1, 1e-6);
    EXPECT_EQ(chart.vertex_count, 4u);
  }
}

}  // namespace
}  // namespace relume::atlas
