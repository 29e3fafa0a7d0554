// SPDX-License-Identifier: MIT
// Light from all around for the tests of bases, and the truth about it by plain sums.
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "relume/basis/basis.h"
#include "relume/basis/direction_set.h"

namespace relume::basis::sky {

using Sky = std::function<Vec3(Direction)>;  ///< radiance

/// Light that changes slowly: two broad lobes of different colours over a grey sky.
inline Sky smooth() {
  return [](Direction d) {
    const Gaussian warm{glm::normalize(Vec3(0.5f, 0.2f, 0.8f)), 1.5f, 2.0f};
    const Gaussian cold{glm::normalize(Vec3(-0.6f, 0.3f, 0.4f)), 2.0f, 1.0f};
    return Vec3(0.4f) + warm(d) * Vec3(1.0f, 0.7f, 0.4f) + cold(d) * Vec3(0.2f, 0.5f, 1.0f);
  };
}

/// A small bright lamp 40 degrees off +z, nothing else.
inline Sky lamp() {
  return [](Direction d) {
    return Gaussian{glm::normalize(Vec3(0.6f, 0.2f, 0.75f)), 60.0f, 20.0f}(d)*Vec3(1.0f);
  };
}

/// The same light, cut off below the surface.
inline Sky above(Sky sky, Normal n) {
  return [sky = std::move(sky), n](Direction d) { return glm::dot(d, n) > 0 ? sky(d) : Vec3(0.0f); };
}

inline const std::vector<Direction>& net() {
  static const std::vector<Direction> directions = sphericalFibonacci(1 << 15);
  return directions;
}
inline double netWeight() { return 4 * M_PI / static_cast<double>(net().size()); }

inline Vec3 irradiance(const Sky& light, Normal n) {
  glm::dvec3 e(0);
  for (const Direction d : net())
    if (const float c = glm::dot(d, n); c > 0) e += glm::dvec3(light(d) * c) * netWeight();
  return Vec3(e);
}

inline Vec3 glossy(const Sky& light, const GlossyLobe& lobe) {
  glm::dvec3 sum(0);
  for (const Direction d : net()) sum += glm::dvec3(light(d) * lobe.evaluate(d)) * netWeight();
  return Vec3(sum);
}

/// Coefficients of the light. From a sphere of light each sample counts as if it came at a cosine of 1.
inline std::vector<float> project(const Basis& basis, const Receiver& at, const Sky& light,
                                  bool all_around = false) {
  std::vector<double> sums(basis.sums(), 0.0);
  for (const Direction d : net()) {
    const float c = glm::dot(d, at.normal);
    if (!all_around && !(c > 0)) continue;
    const float cosine = all_around ? 1.0f : c;
    basis.add(at, {d, Irradiance(light(d) * cosine * static_cast<float>(netWeight())), cosine}, sums);
  }
  const std::vector<float> rounded(sums.begin(), sums.end());
  std::vector<float> coefficients(basis.coefficients());
  basis.finish(at, rounded, coefficients);
  return coefficients;
}

/// Normals that a normal map makes of `n`: up to 45 degrees off.
inline std::vector<Normal> turned(Normal n) {
  std::vector<Normal> normals;
  for (const Direction d : sphericalFibonacci(200))
    if (glm::dot(d, n) > std::sqrt(0.5f)) normals.push_back(d);
  return normals;
}

}  // namespace relume::basis::sky
