// SPDX-License-Identifier: MIT
#include "light_shapes.h"

#include <algorithm>
#include <cmath>

#include "relume/core/sampling.h"
#include "spherical_triangle.h"

namespace relume::transport {
namespace {

/// Whether light leaves a side that faces by this cosine, and by which it is then seen.
std::optional<float> facingOf(float cosine, bool two_sided) {
  if (two_sided) cosine = std::abs(cosine);
  return cosine > 0 ? std::optional(cosine) : std::nullopt;
}

/// Towards q, without value and density; no direction where p is q.
std::optional<LightSample> towards(Point p, Point q) {
  const float distance = glm::length(q - p);
  if (!(distance > 0)) return std::nullopt;
  LightSample s;
  s.direction = (q - p) / distance;
  s.end = q;
  return s;
}

}  // namespace

LightSample Disk::sample(Point p, Vec2 u) const {
  const Vec2 place = radius * squareToDisk(u);
  const Frame frame = Frame::about(normal);
  auto s = towards(p, centre + place.x * frame.t + place.y * frame.b);
  if (!s) return {};
  const auto facing = facingOf(-glm::dot(normal, s->direction), two_sided);
  if (!facing) return *s;
  const Vec3 way = s->end - p;
  s->value = radiance.rgb;
  s->pdf = glm::dot(way, way) / (*facing * kPi * radius * radius);
  return *s;
}

std::optional<LightSeen> Disk::seen(const OpenRay& ray) const {
  const float cosine = -glm::dot(normal, ray.d);
  const auto facing = facingOf(cosine, two_sided);
  if (!facing) return std::nullopt;
  const float t = -glm::dot(normal, centre - ray.from) / cosine;
  if (!(t > ray.near && t < ray.far)) return std::nullopt;
  const Vec3 off = ray.from + t * ray.d - centre;
  if (glm::dot(off, off) > radius * radius) return std::nullopt;
  return LightSeen{radiance, t * t / (*facing * kPi * radius * radius)};
}

LightSample Panel::sample(Point p, Vec2 u) const {
  const TriangleSample place = sampleTriangle(p, v0, v1, v2, u);
  if (!(place.pdf > 0)) return {};
  auto s = towards(p, (1 - place.b1 - place.b2) * v0 + place.b1 * v1 + place.b2 * v2);
  if (!s) return {};
  if (!facingOf(-glm::dot(normal, s->direction), two_sided)) return *s;
  s->value = radiance.rgb;
  s->pdf = place.pdf;
  return *s;
}

std::optional<LightSeen> Panel::seen(const OpenRay& ray) const {
  const float cosine = -glm::dot(normal, ray.d);
  if (!facingOf(cosine, two_sided)) return std::nullopt;
  // On which side of each edge the ray passes. Panels that share an edge form the same product with the other
  // sign, so that no ray passes between them.
  const Vec3 a = v0 - ray.from, b = v1 - ray.from, c = v2 - ray.from;
  const float ab = glm::dot(glm::cross(a, b), ray.d), bc = glm::dot(glm::cross(b, c), ray.d),
              ca = glm::dot(glm::cross(c, a), ray.d);
  const bool inside = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  if (!inside) return std::nullopt;
  const float t = -glm::dot(normal, a) / cosine;
  if (!(t > ray.near && t < ray.far)) return std::nullopt;
  return LightSeen{radiance, trianglePdf(ray.from, v0, v1, v2, ray.d, t)};
}

float Sun::height() const {
  const float s = std::sin(0.5f * angular_radius);
  return 2.0f * s * s;
}

Radiance Sun::radiance() const {
  const float sine = std::sin(angular_radius);
  return Radiance(irradiance * (kInvPi / (sine * sine)));
}

bool Sun::covers(Direction d) const {
  const Vec3 apart = d - to_light;
  return glm::dot(apart, apart) <= 2.0f * height();
}

float Sun::estimate(Normal n) const {
  if (n == Normal(0)) return luminance(irradiance);
  const float c = glm::dot(n, to_light), s = std::sqrt(std::max(0.0f, 1.0f - c * c));
  const float cos_radius = 1.0f - height();
  // The highest point of the disk.
  const float highest = c >= cos_radius ? 1.0f : c * cos_radius + s * std::sin(angular_radius);
  return luminance(irradiance) * std::max(highest, 0.0f);
}

LightSample Sun::sample(Vec2 u) const {
  LightSample s;
  s.endless = true;
  s.direction = to_light;
  s.delta = delta();
  if (s.delta) {
    s.value = irradiance, s.pdf = 1.0f;
    return s;
  }
  const float high = u.x * height(), phi = 2 * kPi * u.y;
  const float sine = std::sqrt(high * (2.0f - high));
  s.direction = Frame::about(to_light).toWorld({sine * std::cos(phi), sine * std::sin(phi), 1.0f - high});
  s.value = radiance().rgb, s.pdf = pdf();
  return s;
}

}  // namespace relume::transport
