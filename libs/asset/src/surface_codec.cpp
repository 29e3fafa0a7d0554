// SPDX-License-Identifier: MIT
#include "surface_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "relume/core/error.h"

namespace relume::asset {
namespace {

constexpr int kPositionBits = 23;
constexpr int kLeastExponent = -126;  // of normal floats
constexpr float kOctahedralMax = 32767.0f;

[[noreturn]] void bad(const char* what, std::size_t item, const char* problem) {
  throw Error(ErrorCode::kInvalidValue, fmt::format("{} {}", what, item), problem);
}

std::uint16_t octahedralInteger(float x) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * kOctahedralMax) +
                                    static_cast<long>(kOctahedralMax));
}

float awayFromZero(float x) { return x < 0 ? -1.0f : 1.0f; }

// The lower half of the octahedron is folded over the diagonals of the square.
Vec2 fold(Vec2 p) {
  return {(1 - std::abs(p.y)) * awayFromZero(p.x), (1 - std::abs(p.x)) * awayFromZero(p.y)};
}

}  // namespace

Grid gridOf(const std::vector<Point>& positions, const char* what, float coarsest) {
  Box3 box;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!isFinite(positions[i])) bad(what, i, "has a position that is not finite");
    box.add(positions[i]);
  }
  if (box.empty()) return {};
  const Vec3 extent = box.extent();
  const float largest = std::max({extent.x, extent.y, extent.z});
  if (!std::isfinite(largest)) bad(what, 0, "lies farther from another than a float can say");
  // ilogb + 1 bits hold the extent; never finer than the smallest normal float.
  if (!(largest > 0)) return {box.lo, 1.0f};
  int exponent = std::max(std::ilogb(largest) + 1 - kPositionBits, kLeastExponent);
  if (coarsest > 0) exponent = std::max(exponent, std::ilogb(coarsest));
  return {box.lo, std::ldexp(1.0f, exponent)};
}

std::vector<std::uint32_t> encodePositions(const std::vector<Point>& positions, const Grid& grid) {
  std::vector<std::uint32_t> q;
  q.reserve(positions.size() * 3);
  for (const Point& p : positions)
    for (int c = 0; c < 3; ++c)
      q.push_back(
          static_cast<std::uint32_t>(std::lround((static_cast<double>(p[c]) - grid.origin[c]) / grid.step)));
  return q;
}

Point decodePosition(const std::uint32_t* q, const Grid& grid) {
  Point p;
  for (int c = 0; c < 3; ++c)
    p[c] = static_cast<float>(grid.origin[c] + static_cast<double>(grid.step) * q[c]);
  return p;
}

std::vector<std::uint16_t> encodeNormals(const std::vector<Normal>& normals, const char* what) {
  std::vector<std::uint16_t> q;
  q.reserve(normals.size() * 2);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Normal n = normals[i];
    const float norm = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (!(norm > 0.5f && norm < 2.0f)) bad(what, i, "has a normal that is not of unit length");
    Vec2 p = Vec2(n.x, n.y) / norm;
    if (n.z < 0) p = fold(p);
    q.push_back(octahedralInteger(p.x));
    q.push_back(octahedralInteger(p.y));
  }
  return q;
}

Normal decodeNormal(const std::uint16_t* q) {
  Vec2 p = Vec2(q[0], q[1]) / kOctahedralMax - Vec2(1.0f);
  const float z = 1 - std::abs(p.x) - std::abs(p.y);
  if (z < 0) p = fold(p);
  return glm::normalize(Vec3(p, z));
}

}  // namespace relume::asset
