// SPDX-License-Identifier: MIT
#include "radiosity/hemicube.h"

#include <cmath>

#include "relume/core/check.h"

namespace relume::transport {

double polygonFormFactor(const std::vector<glm::dvec3>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i]), b = glm::normalize(corners[(i + 1) % corners.size()]);
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * across.z / sine;
  }
  return sum / (2 * M_PI);
}

std::vector<HemicubePixel> hemicube(std::uint32_t resolution) {
  RELUME_CHECK(resolution > 0 && resolution % 8 == 0);
  constexpr std::uint32_t kBlock = 4;
  std::vector<HemicubePixel> pixels;
  pixels.reserve(std::size_t{3} * resolution * resolution);
  // origin + s a + t b, s and t in [0, 1]: a face of columns x rows pixels.
  const auto face = [&](glm::dvec3 origin, glm::dvec3 a, glm::dvec3 b, std::uint32_t columns,
                        std::uint32_t rows) {
    const auto at = [&](double s, double t) { return origin + s / columns * a + t / rows * b; };
    for (std::uint32_t y0 = 0; y0 < rows; y0 += kBlock)
      for (std::uint32_t x0 = 0; x0 < columns; x0 += kBlock)
        for (std::uint32_t y = y0; y < y0 + kBlock; ++y)
          for (std::uint32_t x = x0; x < x0 + kBlock; ++x) {
            const double factor = polygonFormFactor({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
            pixels.push_back(
                {Direction(glm::normalize(at(x + 0.5, y + 0.5))), static_cast<float>(std::abs(factor))});
          }
  };
  face({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, resolution, resolution);
  for (const double side : {-1.0, 1.0}) {
    face({side, -1, 0}, {0, 2, 0}, {0, 0, 1}, resolution, resolution / 2);
    face({-1, side, 0}, {2, 0, 0}, {0, 0, 1}, resolution, resolution / 2);
  }
  return pixels;
}

}  // namespace relume::transport
