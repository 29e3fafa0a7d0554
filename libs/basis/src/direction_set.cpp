// SPDX-License-Identifier: MIT
#include "relume/basis/direction_set.h"

#include <cmath>

#include "relume/core/check.h"

namespace relume::basis {

std::vector<Direction> sphericalFibonacci(std::size_t n) {
  RELUME_CHECK(n >= 1);
  const double golden = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Direction> set(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<double>(i);
    const double z = 1 - (2 * k + 1) / static_cast<double>(n), r = std::sqrt(std::max(0.0, 1 - z * z)),
                 phi = 2 * M_PI * (k / golden - std::floor(k / golden));
    set[i] = glm::normalize(glm::dvec3(r * std::cos(phi), r * std::sin(phi), z));
  }
  return set;
}

std::vector<Direction> minimalEnergy(std::size_t n) {
  constexpr int kSteps = 2000;
  std::vector<glm::dvec3> at;
  for (const Direction d : sphericalFibonacci(n)) at.emplace_back(d);
  if (n == 1) return {at[0]};
  // Step by step along the force, shorter and shorter: a step is a share of the distance between neighbours.
  const double spacing = std::sqrt(4 * M_PI / static_cast<double>(n));
  std::vector<glm::dvec3> force(n);
  for (int step = 0; step < kSteps; ++step) {
    double most = 0;
    for (std::size_t i = 0; i < n; ++i) {
      glm::dvec3 f(0);
      for (std::size_t j = 0; j < n; ++j) {
        if (j == i) continue;
        const glm::dvec3 away = at[i] - at[j];
        const double length = glm::length(away);
        f += away / (length * length * length);
      }
      force[i] = f - glm::dot(f, at[i]) * at[i];
      most = std::max(most, glm::length(force[i]));
    }
    if (!(most > 1e-12)) break;
    const double share = 0.2 * spacing * (1 - static_cast<double>(step) / kSteps);
    for (std::size_t i = 0; i < n; ++i)
      at[i] = glm::normalize(at[i] + force[i] * std::min(share / most, 0.3 * spacing * spacing * spacing));
  }
  std::vector<Direction> set;
  for (const glm::dvec3& d : at) set.emplace_back(d);
  return set;
}

std::size_t nearestFacing(std::span<const Direction> set, Direction d, Normal n) {
  std::size_t best = set.size();
  float nearest = -2;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const float cosine = glm::dot(set[i], d);
    if (cosine > nearest && glm::dot(set[i], n) > kFacing) nearest = cosine, best = i;
  }
  RELUME_CHECK(best < set.size());
  return best;
}

}  // namespace relume::basis
