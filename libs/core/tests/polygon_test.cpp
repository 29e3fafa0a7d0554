// SPDX-License-Identifier: MIT
// Triangles of polygons: they cover what the outline encloses, once.
#include "relume/core/polygon.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relume/core/frame.h"
#include "relume/core/vec.h"

namespace relume {
namespace {

using Outline = std::vector<Vec2>;

/// Somewhere in space.
std::vector<Point> placed(const Outline& outline) {
  const Frame frame = Frame::about(glm::normalize(Vec3(0.3f, -0.8f, 0.4f)));
  std::vector<Point> corners;
  for (const Vec2 p : outline) corners.push_back(Point(5, -2, 1) + p.x * frame.t + p.y * frame.b);
  return corners;
}

/// By the outline alone: the shoelace formula, and how often it goes round a point.
double areaOf(const Outline& o) {
  double sum = 0;
  for (std::size_t i = 0; i < o.size(); ++i) {
    const Vec2 a = o[i], b = o[(i + 1) % o.size()];
    sum += 0.5 * (static_cast<double>(a.x) * b.y - static_cast<double>(b.x) * a.y);
  }
  return sum;
}

double areaOf(const std::array<Point, 3>& t) {
  return 0.5 * static_cast<double>(glm::length(glm::cross(t[1] - t[0], t[2] - t[0])));
}

struct Case {
  const char* name;
  Outline outline;
};
const Case kSound[] = {
    {"triangle", {{0, 0}, {1, 0}, {0, 1}}},
    {"L", {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}},
    {"arrow", {{0, 0}, {2, 1}, {0, 2}, {0.5f, 1}}},
    {"comb",
     {{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {5, 1}, {5, 3}, {4, 3}, {4, 1}, {3, 1}, {3, 3}, {0, 3}}},
    {"corners on straight lines", {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}},
    {"spiral",
     {{0, 0}, {5, 0}, {5, 5}, {1, 5}, {1, 2}, {3, 2}, {3, 3}, {2, 3}, {2, 4}, {4, 4}, {4, 1}, {0, 1}}},
};

TEST(Polygon, TrianglesCoverWhatTheOutlineEncloses) {
  for (const Case& c : kSound) {
    const std::vector<Point> corners = placed(c.outline);
    const glm::dvec3 area = areaVector(corners);
    EXPECT_NEAR(glm::length(area), areaOf(c.outline), 1e-5) << c.name;
    const auto triangles = triangulate(corners);
    EXPECT_LE(triangles.size(), c.outline.size() - 2) << c.name;
    double sum = 0;
    for (const auto& t : triangles) {
      sum += areaOf(t);
      // All face as the polygon does: with the sum of the areas right, none overlaps another.
      EXPECT_GT(glm::dot(glm::dvec3(glm::cross(t[1] - t[0], t[2] - t[0])), area), 0) << c.name;
    }
    EXPECT_NEAR(sum, areaOf(c.outline), 1e-5) << c.name;
  }
}

TEST(Polygon, TheSideFollowsTheSenseOfTheCorners) {
  Outline reversed = kSound[1].outline;
  std::reverse(reversed.begin(), reversed.end());
  const glm::dvec3 there = areaVector(placed(kSound[1].outline)), back = areaVector(placed(reversed));
  EXPECT_NEAR(glm::length(there + back), 0, 1e-5);
  EXPECT_EQ(triangulate(placed(reversed)).size(), 4u);
}

TEST(Polygon, ManyCorners) {
  Outline star;
  for (int i = 0; i < 1000; ++i) {
    const float angle = 2 * kPi * static_cast<float>(i) / 1000, radius = i % 2 ? 1.0f : 2.0f;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  double sum = 0;
  const auto triangles = triangulate(placed(star));
  for (const auto& t : triangles) sum += areaOf(t);
  EXPECT_EQ(triangles.size(), 998u);
  EXPECT_NEAR(sum, areaOf(star), 1e-4);
}

TEST(Polygon, WhatIsNoOutlineHasNone) {
  const Case broken[] = {
      {"bow tie", {{0, 0}, {2, 2}, {2, 0}, {0, 1}}},
      {"a corner twice", {{0, 0}, {1, 0}, {1, 0}, {0, 1}}},
      {"a line", {{0, 0}, {1, 0}, {2, 0}}},
      {"there and back", {{0, 0}, {3, 0}, {1, 0}, {1, 1}}},
      {"touches itself", {{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}},
      {"two corners", {{0, 0}, {1, 0}}},
      {"nothing", {}},
  };
  for (const Case& c : broken) {
    std::vector<Point> corners;  // in a plane in which coordinates are exact
    for (const Vec2 p : c.outline) corners.emplace_back(p.x, p.y, 0.0f);
    EXPECT_TRUE(triangulate(corners).empty()) << c.name;
  }
}

}  // namespace
}  // namespace relume
