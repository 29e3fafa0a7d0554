// SPDX-License-Identifier: MIT
// The vector types of the project: glm's, single precision, column-major, right-handed, +Y up, metres.
#pragma once
#include <glm/glm.hpp>
#include <limits>

namespace relume {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using IVec2 = glm::ivec2;
using UVec3 = glm::uvec3;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;

// What a Vec3 means where it stands. A Direction and a Normal have unit length.
using Point = Vec3;
using Direction = Vec3;
using Normal = Vec3;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Axis-aligned box; empty until something is added.
struct Box3 {
  Point lo{kInfinity, kInfinity, kInfinity};
  Point hi{-kInfinity, -kInfinity, -kInfinity};

  bool empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
  Vec3 extent() const { return empty() ? Vec3(0) : hi - lo; }
  float diagonal() const { return glm::length(extent()); }
  Point centre() const { return 0.5f * (lo + hi); }
  void add(Point p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  void add(const Box3& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
  bool overlaps(const Box3& b) const {
    return glm::all(glm::lessThanEqual(lo, b.hi)) && glm::all(glm::lessThanEqual(b.lo, hi));
  }
  /// Distance from a point to the box, metres; 0 inside.
  float distance(Point p) const { return glm::length(glm::max(glm::max(lo - p, p - hi), Vec3(0))); }
};

inline bool isFinite(Vec3 v) { return glm::all(glm::lessThan(glm::abs(v), Vec3(kInfinity))); }

}  // namespace relume
