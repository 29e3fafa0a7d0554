// SPDX-License-Identifier: MIT
#include "relume/core/light.h"

#include <algorithm>
#include <cmath>

#include "relume/core/frame.h"
#include "relume/core/sampling.h"

namespace relume {
namespace {

// KHR_lights_punctual: the recommended window that brings the inverse square to zero at `range`.
float rangeWindow(float r, float range) {
  if (!(range < kInfinity)) return 1.0f;
  const float q = r / range;
  return std::clamp(1.0f - q * q * q * q, 0.0f, 1.0f);
}

// KHR_lights_punctual: smooth cone between the inner and the outer angle.
float coneFactor(const Light& light, float cos_angle) {
  const float cos_outer = std::cos(light.outer_cone), cos_inner = std::cos(light.inner_cone);
  const float s = std::clamp((cos_angle - cos_outer) / std::max(0.001f, cos_inner - cos_outer), 0.0f, 1.0f);
  return s * s;
}

}  // namespace

float distanceTo(const Light& light, Point p) {
  return light.kind == Light::Kind::kDirectional ? kInfinity : glm::length(light.position - p);
}

Direction directionTo(const Light& light, Point p) {
  if (light.kind == Light::Kind::kDirectional) return -light.direction;
  const Vec3 d = light.position - p;
  const float r = glm::length(d);
  return r > 0 ? d / r : -light.direction;
}

Irradiance incidentIrradiance(const Light& light, Point p) {
  const Vec3 strength = light.colour * light.intensity;
  if (light.kind == Light::Kind::kDirectional) return Irradiance(strength);
  const float r = distanceTo(light, p);
  float cos_light = glm::dot(light.direction, -directionTo(light, p));
  if (light.kind == Light::Kind::kArea && light.two_sided) cos_light = std::abs(cos_light);
  if (light.kind == Light::Kind::kArea)
    return Irradiance(strength * (light.area * std::max(cos_light, 0.0f) / (r * r + light.area * kInvPi)));
  if (!(r > 0)) return Irradiance(0.0f);
  float factor = rangeWindow(r, light.range) / (r * r);
  if (light.kind == Light::Kind::kSpot) factor *= coneFactor(light, cos_light);
  return Irradiance(strength * factor);
}

Point pointOn(const Light& light, Vec2 u) {
  if (light.kind != Light::Kind::kArea) return light.position;
  if (light.triangles.empty()) {
    const Vec2 d = std::sqrt(light.area * kInvPi) * squareToDisk(u);
    const Frame frame = Frame::about(light.direction);
    return light.position + d.x * frame.t + d.y * frame.b;
  }
  // u.x chooses the triangle; what it has left beyond the choice is uniform again.
  const auto area = [](const std::array<Point, 3>& t) {
    return 0.5f * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
  };
  float whole = 0;
  for (const auto& t : light.triangles) whole += area(t);
  float share = u.x * whole;
  std::size_t k = 0;
  for (; k + 1 < light.triangles.size() && share >= area(light.triangles[k]); ++k)
    share -= area(light.triangles[k]);
  const auto& [a, b, c] = light.triangles[k];
  const float own = area(light.triangles[k]);
  const float root = std::sqrt(own > 0 ? std::clamp(share / own, 0.0f, 1.0f) : 0.0f);
  return a + root * (1 - u.y) * (b - a) + root * u.y * (c - a);
}

Irradiance directIrradiance(const Light& light, Point p, Normal n) {
  return incidentIrradiance(light, p) * std::max(glm::dot(n, directionTo(light, p)), 0.0f);
}

}  // namespace relume
