// SPDX-License-Identifier: MIT
// Small convex polygons in the plane of an atlas page: a triangle cut by the sides of texels. Double
// precision, so that the pieces of a triangle add up to it.
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "relume/core/check.h"

namespace relume::atlas {

using DVec2 = glm::dvec2;

inline double cross(DVec2 a, DVec2 b) { return a.x * b.y - a.y * b.x; }

/// A triangle cut by the four sides of a square has at most seven vertices; the others are room for vertices
/// that rounding leaves on a line.
struct Polygon {
  std::array<DVec2, 14> vertex;
  int count = 0;

  Polygon() = default;
  Polygon(const Polygon& other) { *this = other; }
  Polygon& operator=(const Polygon& other) {
    count = other.count;
    for (int i = 0; i < count; ++i) vertex[static_cast<std::size_t>(i)] = other[i];
    return *this;
  }

  void add(DVec2 p) {
    RELUME_CHECK_LT(count, 14);
    vertex[static_cast<std::size_t>(count++)] = p;
  }
  DVec2 operator[](int i) const { return vertex[static_cast<std::size_t>(i)]; }
};

/// Cuts at a line parallel to an axis. `below` and `above` may be null, but not the polygon itself; vertices
/// on the line belong to both.
void splitAtX(const Polygon& polygon, double x, Polygon* below, Polygon* above);
void splitAtY(const Polygon& polygon, double y, Polygon* below, Polygon* above);

/// The part of the triangle (any winding) in the square of texel (x, y); empty if they do not meet.
Polygon clipToTexel(const std::array<DVec2, 3>& triangle, int x, int y);

double area(const Polygon& polygon);     ///< not negative
DVec2 centroid(const Polygon& polygon);  ///< of the vertices where the area is zero
/// The nearest point of the outline.
DVec2 nearestOnOutline(const Polygon& polygon, DVec2 p);

}  // namespace relume::atlas
