// SPDX-License-Identifier: MIT
#include "relume/basis/direction_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "relume/basis/receiver.h"
#include "skies.h"

namespace relume::basis {
namespace {

float leastAngle(const std::vector<Direction>& set) {
  float most = -1;
  for (std::size_t i = 0; i < set.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) most = std::max(most, glm::dot(set[i], set[j]));
  return std::acos(most);
}

TEST(DirectionSet, LeastEnergyFindsOctahedronAndIcosahedron) {
  EXPECT_NEAR(leastAngle(minimalEnergy(6)), kPi / 2, 1e-3f);
  EXPECT_NEAR(leastAngle(minimalEnergy(12)), std::acos(1 / std::sqrt(5.0f)), 1e-3f);
}

/// Energies that are known for Thomson's problem, to 1e-4 of them.
TEST(DirectionSet, LeastEnergyIsTheKnownOne) {
  for (const auto& [n, known] : {std::pair<std::size_t, double>{14, 69.306363297}, {32, 412.261274651}}) {
    const auto set = minimalEnergy(n);
    double energy = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) energy += 1 / static_cast<double>(glm::length(set[i] - set[j]));
    EXPECT_NEAR(energy / known, 1, 1e-4) << n;
  }
}

/// Each direction is the nearest to an equal share of the sphere, up to what the shapes of cells allow.
TEST(DirectionSet, SharesTheSphereEvenly) {
  for (const std::size_t n : {6u, 14u, 64u})
    for (const auto& set : {sphericalFibonacci(n), minimalEnergy(n)}) {
      std::vector<int> near(n, 0);
      for (const Direction d : sky::net()) {
        std::size_t best = 0;
        for (std::size_t i = 1; i < n; ++i)
          if (glm::dot(set[i], d) > glm::dot(set[best], d)) best = i;
        ++near[best];
      }
      const double mean = static_cast<double>(sky::net().size()) / static_cast<double>(n);
      for (const int count : near) EXPECT_NEAR(count / mean, 1, 0.35) << n;
    }
}

TEST(DirectionSet, NearestFacesTheSurface) {
  const auto set = minimalEnergy(14);
  const Normal n = glm::normalize(Vec3(0.1f, 1, 0.2f));
  for (const Direction d : sphericalFibonacci(500)) {
    if (glm::dot(d, n) < 0) continue;
    const std::size_t found = nearestFacing(set, d, n);
    EXPECT_GT(glm::dot(set[found], n), kFacing);
    for (const Direction other : set) {
      if (glm::dot(other, n) > kFacing) {
        EXPECT_LE(glm::dot(other, d), glm::dot(set[found], d));
      }
    }
  }
}

TEST(TangentFrame, TurnsAsNormalsDo) {
  for (const Direction n : sphericalFibonacci(1000)) {
    const Frame f = tangentFrame(n);
    EXPECT_NEAR(glm::dot(glm::cross(f.t, f.b), n), 1, 1e-5f);
    EXPECT_NEAR(glm::dot(f.t, n), 0, 1e-5f);
  }
  // Where walls and floors face there is no jump: a little turn of the normal is a little turn of the frame.
  for (const Normal n : {Normal(1, 0, 0), Normal(-1, 0, 0), Normal(0, 1, 0), Normal(0, -1, 0),
                         Normal(0, 0, 1), Normal(0, 0, -1)})
    for (const Vec3 by : {Vec3(1e-3f, 1e-3f, 0), Vec3(0, -1e-3f, 1e-3f), Vec3(-1e-3f, 0, -1e-3f)})
      EXPECT_NEAR(glm::dot(tangentFrame(n).t, tangentFrame(glm::normalize(n + by)).t), 1, 1e-3f);
}

}  // namespace
}  // namespace relume::basis
