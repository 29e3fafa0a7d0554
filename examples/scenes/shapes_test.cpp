// SPDX-License-Identifier: MIT
// The mesh kit: closed solids are closed, face outward and have the volume of geometry.
#include "shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

namespace relume::scenes {
namespace {

using Edge = std::array<float, 6>;

// Directed edges that lack their opposite, by position.
int openEdges(const std::vector<Primitive>& parts) {
  std::map<Edge, int> count;
  for (const Primitive& part : parts)
    for (const UVec3& t : part.triangles)
      for (int k = 0; k < 3; ++k) {
        const Point a = part.positions[t[k]], b = part.positions[t[(k + 1) % 3]];
        ++count[{a.x, a.y, a.z, b.x, b.y, b.z}], --count[{b.x, b.y, b.z, a.x, a.y, a.z}];
      }
  int open = 0;
  for (const auto& [edge, n] : count) open += n > 0;
  return open;
}

double volume(const std::vector<Primitive>& parts) {
  double sum = 0;
  for (const Primitive& part : parts)
    for (const UVec3& t : part.triangles) {
      const P3 a(part.positions[t.x]), b(part.positions[t.y]), c(part.positions[t.z]);
      sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
  return sum;
}

TEST(Shapes, BevelledBoxIsClosedAndHasItsVolume) {
  MeshBuilder m;
  const double b = 0.125;  // on the grid of positions
  box(m, {-1, 0, -2}, {1, 3, 2}, b);
  const auto parts = m.primitives(30);
  EXPECT_EQ(openEdges(parts), 0);
  // Each edge loses a prism b^2 / 2 between the corner cubes b^3, of which x + y + z >= 2 b, one sixth, is
  // left.
  EXPECT_NEAR(volume(parts), 24 - b * b / 2 * (4 * (2 + 3 + 4) - 24 * b) - 8 * 5.0 / 6 * b * b * b, 1e-9);
  EXPECT_EQ(m.triangleCount(), 44u);
}

TEST(Shapes, BoxWithoutItsBottomIsOpenThereOnly) {
  MeshBuilder m;
  box(m, {-1, 0, -1}, {1, 1, 1}, 0.05, kYLo);
  EXPECT_EQ(openEdges(m.primitives(30)), 8);  // four sides and four bevels stand on the floor
}

TEST(Shapes, LatheOfAHalfCircleIsASphere) {
  MeshBuilder m;
  std::vector<P2> profile;
  constexpr int kRows = 48;
  for (int i = 0; i <= kRows; ++i) {
    const double a = kTau / 2 * i / kRows;
    profile.push_back({i == 0 || i == kRows ? 0.0 : std::sin(a), -std::cos(a)});
  }
  lathe(m, profile, 96);
  const auto parts = m.primitives(30);
  EXPECT_EQ(openEdges(parts), 0);
  EXPECT_NEAR(volume(parts), 4.0 / 3 * kTau / 2, 0.01);
  for (const Primitive& part : parts)
    for (std::size_t i = 0; i < part.positions.size(); ++i)
      ASSERT_GT(glm::dot(part.positions[i], part.normals[i]), 0.999f)
          << "smooth normals of a sphere are its radii";
}

TEST(Shapes, TubeAndCappedSweepAreClosed) {
  MeshBuilder m;
  tube(m, {{0, 0, 0}, {0, 1, 0}, {1, 1.5, 0.5}}, 0.1, 8);
  EXPECT_EQ(openEdges(m.primitives(30)), 0);
  EXPECT_GT(volume(m.primitives(30)), 0.0);
  MeshBuilder s;
  sweep(s, planarPath({{2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {0, 0, 1}), bevelledRectangle(0.4, -0.1, 0.1, 0.02),
        true, true);
  EXPECT_EQ(openEdges(s.primitives(30)), 0);
  const double area = 0.4 * 0.2 - 2 * 0.02 * 0.02;
  EXPECT_NEAR(volume(s.primitives(30)), 4 * area, 1e-3);  // a mitred corner keeps the volume of its axis
}

TEST(Shapes, MirroringKeepsTheOutsideOutside) {
  MeshBuilder one, m;
  box(one, {0, 0, 0}, {1, 1, 1}, 0.1);
  m.append(one, scale({-1, 1, 1}));
  EXPECT_EQ(openEdges(m.primitives(30)), 0);
  EXPECT_GT(volume(m.primitives(30)), 0.9);
}

TEST(Shapes, CreasesDivideNormals) {
  MeshBuilder m;
  box(m, {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(m.primitives(89).at(0).positions.size(), 24u);
  EXPECT_EQ(m.primitives(91).at(0).positions.size(), 8u);
}

TEST(Shapes, PointedArchMeetsItsSpringingAndCrown) {
  const PointedArch arch(4, 3);
  EXPECT_NEAR(arch.height(0), 3, 1e-12);
  EXPECT_NEAR(arch.height(2), 0, 1e-6);
  for (const double y : {0.0, 0.7, 1.9, 2.99}) EXPECT_NEAR(arch.height(arch.halfWidth(y)), y, 1e-9);
  EXPECT_NEAR(arch.at(0).x, 2, 1e-12);
  EXPECT_NEAR(arch.at(1).y, 3, 1e-12);
  EXPECT_NEAR(arch.at(2).x, -2, 1e-12);
}

}  // namespace
}  // namespace relume::scenes
