// SPDX-License-Identifier: MIT
// Cones are found ring by ring about each texel, out to where not even the highest texel of the map could
// make them narrower.
#include "relume/image/relief.h"

#include <algorithm>
#include <cmath>

#include "relume/core/check.h"
#include "relume/core/parallel.h"

namespace relume::image {
namespace {

int wrapped(int i, int n) { return ((i % n) + n) % n; }

float heightAt(const Image& heights, int x, int y) {
  return *heights.at(wrapped(x, heights.width), wrapped(y, heights.height));
}

/// Tangent of half the aperture of the cone over (x, y).
float coneAt(const Image& heights, int x, int y, float highest, float depth) {
  const float own = *heights.at(x, y), texel = 1.0f / static_cast<float>(heights.width);
  const int farthest = std::max(heights.width, heights.height);
  float tangent = kWidestCone;
  const auto meet = [&](int dx, int dy) {
    const float above = depth * (heightAt(heights, x + dx, y + dy) - own);
    if (above > 0)
      tangent = std::min(tangent, texel * std::hypot(static_cast<float>(dx), static_cast<float>(dy)) / above);
  };
  for (int ring = 1; ring <= farthest; ++ring) {
    if (texel * static_cast<float>(ring) >= tangent * depth * (highest - own)) break;
    for (int i = -ring; i <= ring; ++i) meet(i, -ring), meet(i, ring);
    for (int i = 1 - ring; i < ring; ++i) meet(-ring, i), meet(ring, i);
  }
  return tangent;
}

}  // namespace

float smallScaleOcclusion(float cos_alpha, float cos_gamma, float h) {
  return 0.5f * (1 + h * cos_alpha + (1 - h) * cos_gamma);
}

Image reliefNormals(const Image& heights, const ReliefOptions& options) {
  RELUME_CHECK_EQ(heights.channels, 1);
  Image normals(heights.width, heights.height, 3);
  // Texels are square: both slopes count in texels of the width.
  const float scale = 0.5f * options.depth * static_cast<float>(heights.width);
  for (int y = 0; y < heights.height; ++y)
    for (int x = 0; x < heights.width; ++x) {
      const float right = heightAt(heights, x + 1, y) - heightAt(heights, x - 1, y);
      const float up = heightAt(heights, x, y - 1) - heightAt(heights, x, y + 1);
      normals.setRgb(x, y, glm::normalize(Vec3(-scale * right, -scale * up, 1)));
    }
  return normals;
}

Image reliefCones(const Image& heights, const ReliefOptions& options) {
  RELUME_CHECK_EQ(heights.channels, 1);
  Image cones(heights.width, heights.height, 1);
  if (heights.empty()) return cones;
  const float highest = *std::max_element(heights.data.begin(), heights.data.end());
  parallelFor(static_cast<std::size_t>(heights.height), 1, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < heights.width; ++x) {
        const float t = coneAt(heights, x, y, highest, options.depth);
        *cones.at(x, y) = t >= kWidestCone ? 1.0f : t / std::sqrt(1 + t * t);
      }
  });
  return cones;
}

Image reliefOcclusion(const Image& heights, const Image& normals, const Image& cones) {
  RELUME_CHECK_EQ(normals.pixels(), heights.pixels());
  RELUME_CHECK_EQ(cones.pixels(), heights.pixels());
  Image open(heights.width, heights.height, 1);
  for (std::size_t i = 0; i < heights.pixels(); ++i) {
    // gamma = pi - 2 delta: cos gamma = -cos 2 delta = 2 sin^2 delta - 1.
    const float sine = cones.data[i];
    open.data[i] = smallScaleOcclusion(normals.data[3 * i + 2], 2 * sine * sine - 1, heights.data[i]);
  }
  return open;
}

}  // namespace relume::image
