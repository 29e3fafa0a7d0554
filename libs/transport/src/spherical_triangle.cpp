// SPDX-License-Identifier: MIT
#include "spherical_triangle.h"

#include <algorithm>
#include <cmath>

namespace relume::transport {
namespace {

using DVec3 = glm::dvec3;

constexpr double kLeastSolidAngle = 1e-2, kMostSolidAngle = 6.0;  // sr

double angleBetween(DVec3 a, DVec3 b) {
  const double half = 0.5 * glm::length(glm::dot(a, b) < 0 ? a + b : b - a);
  const double angle = 2 * std::asin(std::min(half, 1.0));
  return glm::dot(a, b) < 0 ? M_PI - angle : angle;
}

/// The triangle as seen from the origin.
struct Seen {
  DVec3 corner[3];     // relative to the point
  DVec3 direction[3];  // unit
  double solid_angle = 0;
  bool bySolidAngle() const { return solid_angle > kLeastSolidAngle && solid_angle < kMostSolidAngle; }
};

Seen seenFrom(Point from, Point v0, Point v1, Point v2) {
  Seen seen;
  const Point corners[3] = {v0, v1, v2};
  for (int k = 0; k < 3; ++k) {
    seen.corner[k] = DVec3(corners[k]) - DVec3(from);
    const double length = glm::length(seen.corner[k]);
    if (!(length > 0)) return seen;  // solid angle 0: sampled by area
    seen.direction[k] = seen.corner[k] / length;
  }
  const auto& [a, b, c] = seen.direction;
  const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
  const double denominator = 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a);
  seen.solid_angle = 2 * std::atan2(numerator, denominator);  // [VOS83] (8)
  return seen;
}

/// Per steradian, of a point chosen uniformly on the triangle.
double areaPdf(const Seen& seen, DVec3 d, double distance) {
  const DVec3 normal = glm::cross(seen.corner[1] - seen.corner[0], seen.corner[2] - seen.corner[0]);
  const double twice_area = glm::length(normal);
  const double facing = std::abs(glm::dot(normal, d));  // 2 A cos
  return twice_area > 0 && facing > 0 ? 2 * distance * distance / facing : 0;
}

TriangleSample byArea(const Seen& seen, Vec2 u) {
  const double root = std::sqrt(static_cast<double>(u.x));
  const double b1 = root * (1 - u.y), b2 = root * u.y;
  const DVec3 p = (1 - b1 - b2) * seen.corner[0] + b1 * seen.corner[1] + b2 * seen.corner[2];
  const double distance = glm::length(p);
  if (!(distance > 0)) return {};
  return {static_cast<float>(b1), static_cast<float>(b2),
          static_cast<float>(areaPdf(seen, p / distance, distance))};
}

DVec3 perpendicular(DVec3 v, DVec3 axis) { return glm::normalize(v - glm::dot(v, axis) * axis); }

/// [Arvo95], section 3: the sub-triangle that cuts off the share u.x, then the arc to its new edge.
TriangleSample bySolidAngle(const Seen& seen, Vec2 u) {
  const auto& [a, b, c] = seen.direction;
  const DVec3 ab = glm::normalize(glm::cross(a, b)), bc = glm::normalize(glm::cross(b, c)),
              ca = glm::normalize(glm::cross(c, a));
  const double alpha = angleBetween(ab, -ca), beta = angleBetween(bc, -ab), gamma = angleBetween(ca, -bc);
  const double excess = alpha + beta + gamma - M_PI;
  const double phi = M_PI + u.x * excess;  // area of the sub-triangle + pi
  const double sin_phi = std::sin(phi) * std::cos(alpha) - std::cos(phi) * std::sin(alpha),
               cos_phi = std::cos(phi) * std::cos(alpha) + std::sin(phi) * std::sin(alpha);
  const double k1 = cos_phi + std::cos(alpha), k2 = sin_phi - std::sin(alpha) * glm::dot(a, b);
  const double below = (k2 * sin_phi + k1 * cos_phi) * std::sin(alpha);
  const double cos_new =
      std::clamp((k2 + (k2 * cos_phi - k1 * sin_phi) * std::cos(alpha)) / below, -1.0, 1.0);
  if (!std::isfinite(cos_new)) return byArea(seen, u);
  const DVec3 corner = cos_new * a + std::sqrt(std::max(0.0, 1 - cos_new * cos_new)) * perpendicular(c, a);
  const double cos_theta = 1 - u.y * (1 - glm::dot(corner, b));
  const DVec3 d =
      cos_theta * b + std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta)) * perpendicular(corner, b);

  const DVec3 e1 = seen.corner[1] - seen.corner[0], e2 = seen.corner[2] - seen.corner[0];
  const DVec3 s1 = glm::cross(d, e2);
  const double divisor = glm::dot(s1, e1);
  if (!(std::abs(divisor) > 0) || !std::isfinite(d.x)) return byArea(seen, u);
  const DVec3 s = -seen.corner[0];
  const double b1 = std::clamp(glm::dot(s, s1) / divisor, 0.0, 1.0);
  const double b2 = std::clamp(glm::dot(d, glm::cross(s, e1)) / divisor, 0.0, 1.0 - b1);
  return {static_cast<float>(b1), static_cast<float>(b2), static_cast<float>(1 / seen.solid_angle)};
}

}  // namespace

TriangleSample sampleTriangle(Point from, Point v0, Point v1, Point v2, Vec2 u) {
  const Seen seen = seenFrom(from, v0, v1, v2);
  return seen.bySolidAngle() ? bySolidAngle(seen, u) : byArea(seen, u);
}

float trianglePdf(Point from, Point v0, Point v1, Point v2, Direction d, float distance) {
  const Seen seen = seenFrom(from, v0, v1, v2);
  return static_cast<float>(seen.bySolidAngle() ? 1 / seen.solid_angle : areaPdf(seen, DVec3(d), distance));
}

}  // namespace relume::transport
