// SPDX-License-Identifier: MIT
#include "charts/topology.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <set>

#include "charts_meshes.h"

namespace relume::atlas {
namespace {

using namespace test;

std::size_t borderEdges(const Topology& topology) {
  std::size_t count = 0;
  for (std::uint32_t h = 0; h < topology.mate.size(); ++h) {
    if (!topology.degenerate(h / 3) && topology.mate[h] == kNone) ++count;
  }
  return count;
}

TEST(ChartsTopology, VerticesSplitByNormalsAreOne) {
  const scene::Mesh mesh = cube();  // 24 vertices in 8 places
  const Topology topology = connect(mesh, Mat3(1.0f));
  EXPECT_EQ(std::set<std::uint32_t>(topology.point.begin(), topology.point.end()).size(), 8u);
  EXPECT_EQ(borderEdges(topology), 0u);
  for (std::uint32_t h = 0; h < topology.mate.size(); ++h) {
    const std::uint32_t mate = topology.mate[h];
    ASSERT_NE(mate, kNone);
    EXPECT_EQ(topology.mate[mate], h);
    EXPECT_EQ(topology.point[topology.vertex(h)], topology.point[topology.vertex(nextHalfEdge(mate))]);
  }
}

TEST(ChartsTopology, NegativeZeroIsZero) {
  scene::Mesh mesh = emptyMesh("zeros");
  addTriangle(mesh, {0.0f, 0, 0}, {1, 0, 0}, {0.0f, 1, 0});
  addTriangle(mesh, {-0.0f, -0.0f, 0}, {-0.0f, 1, -0.0f}, {-1, 0, 0});
  EXPECT_EQ(borderEdges(connect(mesh, Mat3(1.0f))), 4u);
}

TEST(ChartsTopology, SidesOfASheetStayApart) {
  const scene::Mesh topology_mesh = twoSided();
  const Topology topology = connect(topology_mesh, Mat3(1.0f));
  for (std::uint32_t h = 0; h < topology.mate.size(); ++h) {
    if (topology.mate[h] == kNone) continue;
    const float cosine = glm::dot(topology.normal[h / 3], topology.normal[topology.mate[h] / 3]);
    EXPECT_TRUE(cosine > 0.99f || cosine < -0.99f);
  }
  // The diagonals join the halves of each side, not the sides.
  EXPECT_EQ(topology.mate[2] / 3, 1u);
  EXPECT_EQ(topology.mate[3 * 2 + 0] / 3, 3u);
}

TEST(ChartsTopology, AtManySheetsTheFlattestPairsMeet) {
  const scene::Mesh mesh = book(5);
  const Topology topology = connect(mesh, Mat3(1.0f));
  // All leaves run the same way along the spine: no two may be mates there, each leaf keeps its own diagonal.
  for (std::uint32_t leaf = 0; leaf < 5; ++leaf)
    EXPECT_EQ(topology.mate[3 * (2 * leaf) + 2] / 3, 2 * leaf + 1);
  EXPECT_EQ(borderEdges(topology), 5u * 4u);
}

TEST(ChartsTopology, DegenerateTrianglesHaveNoAreaAndNoMates) {
  scene::Mesh mesh = grid(1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  addTriangle(mesh, {0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0});
  addTriangle(mesh, {0, 0, 0}, {0, 0, 0}, {1, 1, 1});
  addTriangle(mesh, {0, nan, 0}, {1, 0, 0}, {1, 1, 1});
  addTriangle(mesh, {1e30f, 0, 0}, {0, 1e30f, 0}, {0, 0, 1e30f});
  const Topology topology = connect(mesh, Mat3(1.0f));
  EXPECT_FALSE(topology.degenerate(0));
  for (std::uint32_t t = 2; t < 6; ++t) {
    EXPECT_TRUE(topology.degenerate(t));
    for (std::uint32_t e = 0; e < 3; ++e) EXPECT_EQ(topology.mate[3 * t + e], kNone);
  }
}

TEST(ChartsTopology, MetricChangesAnglesAndAreas) {
  const scene::Mesh mesh = cube();
  const Topology topology = connect(mesh, Mat3(glm::scale(Mat4(1.0f), Vec3(3, 1, 1))));
  EXPECT_NEAR(std::accumulate(topology.area.begin(), topology.area.end(), 0.0f), 2 * (3 + 3 + 1), 1e-5);
}

}  // namespace
}  // namespace relume::atlas
