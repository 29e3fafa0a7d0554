// SPDX-License-Identifier: MIT
// Solutions of the radiosity equations, with form factors that are known and with those of scenes.
#include "radiosity/system.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patched_scene.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

/// A system that owns what it is made of.
struct Owned {
  FormFactors factors;
  std::vector<Vec3> exitance, irradiance, reflectance;
  std::vector<float> area;
  RadiositySystem system() const { return {factors, exitance, irradiance, reflectance, area}; }
};

FormFactors dense(const std::vector<std::vector<float>>& rows) {
  FormFactors factors(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<FormFactors::Entry> row;
    for (std::uint32_t j = 0; j < rows[i].size(); ++j)
      if (rows[i][j] > 0) row.push_back({j, rows[i][j]});
    factors.set(i, row, 1);
  }
  return factors;
}

/// Patches of a scene that emit and reflect what their materials say.
Owned ofScene(const made::Patched& patched, std::uint32_t side, std::uint32_t rays) {
  const Patches patches = patched.patches(side);
  Owned owned{patched.sampled(patches, rays), {}, {}, {}, {}};
  std::vector<Vec3> albedo, exitance;
  for (const atlas::SurfacePoint& p : patched.texels.points)
    albedo.push_back(p.albedo.rgb), exitance.push_back(kPi * p.emission.rgb);
  owned.reflectance = patches.means(patched.texels, albedo);
  owned.exitance = patches.means(patched.texels, exitance);
  owned.irradiance.assign(patches.size(), Vec3(0));
  for (const Patch& p : patches.all) owned.area.push_back(p.area);
  return owned;
}

using Solve = RadiositySolution (*)(const RadiositySystem&, const RadiosityLimits&);
constexpr Solve kBoth[] = {solveByGathering, solveByShooting};

TEST(RadiositySystem, Plates) {
  // Two endless plates: each sees only the other.
  const Owned plates{
      dense({{0, 1}, {1, 0}}), {Vec3(3), Vec3(1)}, {Vec3(0), Vec3(0)}, {Vec3(0.5f), Vec3(0.8f)}, {1, 1}};
  for (const Solve solve : kBoth) {
    const RadiositySolution s = solve(plates.system(), {.residual = 1e-9});
    EXPECT_NEAR(s.radiosity[0].x, 5.833333333333334, 5.8e-7);
    EXPECT_NEAR(s.radiosity[1].y, 5.666666666666668, 5.8e-7);
    EXPECT_LE(s.residual, 1e-9);
  }
}

TEST(RadiositySystem, ConcentricSpheres) {
  // The inner sphere sees the outer; that sees a quarter of the inner one and itself.
  const Owned known{dense({{0, 1}, {0.25f, 0.75f}}),
                    {Vec3(2), Vec3(0)},
                    {Vec3(0), Vec3(0)},
                    {Vec3(0.3f), Vec3(0.7f)},
                    {1, 4}};
  for (const Solve solve : kBoth) {
    const RadiositySolution s = solve(known.system(), {.residual = 1e-9});
    EXPECT_NEAR(s.radiosity[0].x, 2.2485207100591715, 1e-6);
    EXPECT_NEAR(s.radiosity[1].x, 0.8284023668639051, 1e-6);
  }
  scene::Scene scene = made::cavity(1, 0, Vec3(0.7f));
  made::addMaterial(scene, Vec3(0.3f)).emission = Vec3(2 / kPi);
  scene::Mesh inner;
  made::addSphere(inner, Point(0), 0.5f, 48, 96);
  made::addInstance(scene, std::move(inner), 1);
  const made::Patched spheres(std::move(scene));
  const Owned own = ofScene(spheres, 4, 1024);
  const RadiositySolution s = solveByGathering(own.system(), {});
  const Patches patches = spheres.patches(4);
  double sum[2] = {}, area[2] = {};
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const std::uint32_t instance = spheres.instanceOf(patches, i);
    sum[instance] += static_cast<double>(own.area[i]) * s.radiosity[i].x,
        area[instance] += static_cast<double>(own.area[i]);
  }
  EXPECT_NEAR(sum[1] / area[1], 2.2485207100591715, 2e-3);
  EXPECT_NEAR(sum[0] / area[0], 0.8284023668639051, 4e-3);
}

TEST(RadiositySystem, AFurnaceOfPatchesIsExact) {
  // Rows sum to 1, so B is the same everywhere whatever the noise of the form factors: 8, and 2 (1 - 0.75^(k
  // + 1)) / 0.25 after k bounces.
  const made::Patched furnace(made::box({4, 3, 2.5f}, Vec3(0.75f), Vec3(2 / kPi)), 32);
  const Owned own = ofScene(furnace, 4, 256);
  for (const Solve solve : kBoth) {
    for (const glm::dvec3& b : solve(own.system(), {.residual = 1e-8}).radiosity) EXPECT_NEAR(b.x, 8.0, 1e-5);
    for (const int k : {0, 1, 2, 7})
      for (const glm::dvec3& b : solve(own.system(), {.bounces = k}).radiosity)
        EXPECT_NEAR(b.x, 8 * (1 - std::pow(0.75, k + 1)), 1e-5);
  }
}

TEST(RadiositySystem, GatheringAndShootingAgree) {
  const made::Patched room(made::colouredRoom(true), 32);
  Owned own = ofScene(room, 4, 256);
  for (std::size_t i = 0; i < own.irradiance.size(); ++i)  // some light from elsewhere too
    own.irradiance[i] = Vec3(0.1f, 0.2f, static_cast<float>(i % 7));
  const auto compare = [&](const RadiosityLimits& limits, double tolerance) {
    const RadiositySolution a = solveByGathering(own.system(), limits),
                            b = solveByShooting(own.system(), limits);
    for (std::size_t i = 0; i < a.radiosity.size(); ++i)
      EXPECT_LT(glm::length(a.radiosity[i] - b.radiosity[i]), tolerance * glm::length(a.radiosity[i]) + 1e-12)
          << i;
    return std::pair(a.residual, b.residual);
  };
  const auto [gathering, shooting] = compare({.residual = 1e-8}, 1e-6);
  EXPECT_LE(gathering, 1e-8);
  EXPECT_LE(shooting, 1e-8);
  compare({.bounces = 1}, 1e-12);
  compare({.bounces = 3}, 1e-12);
  // The residual is what it says.
  const RadiositySolution s = solveByShooting(own.system(), {.residual = 1e-3});
  EXPECT_LE(residualOf(own.system(), s.radiosity), 1e-3);
  EXPECT_GT(residualOf(own.system(), s.radiosity), 1e-5);
}

TEST(RadiositySystem, EnergyIsKept) {
  // What the lamp sends out is absorbed, but for the noise of form factors: their columns hold it.
  const made::Patched room(made::colouredRoom(false));
  const Owned own = ofScene(room, 4, 1024);
  const RadiositySolution s = solveByGathering(own.system(), {});
  glm::dvec3 absorbed(0), emitted(0);
  for (std::size_t i = 0; i < own.area.size(); ++i) {
    const glm::dvec3 rho(own.reflectance[i]), arrives = own.factors.times(i, s.radiosity);
    absorbed += static_cast<double>(own.area[i]) * (1.0 - rho) * arrives;
    emitted += static_cast<double>(own.area[i]) * glm::dvec3(own.exitance[i]);
  }
  const glm::dvec3 exact(13.351768777756622, 9.42477796076938, 3.141592653589793);
  made::expectNear(emitted, exact, 1e-3, "emitted");
  made::expectNear(absorbed, exact, 3e-3, "absorbed");
}

TEST(RadiositySystem, TheAmbientTermStandsForWhatIsNotShotYet) {
  // In a furnace it is exact from the first shot on: no patch differs from the mean.
  const made::Patched furnace(made::box({4, 3, 2.5f}, Vec3(0.75f), Vec3(2 / kPi)), 32);
  const Owned own = ofScene(furnace, 4, 1024);
  double area = 0;
  for (const float a : own.area) area += static_cast<double>(a);
  for (const std::uint64_t shots : {1u, 10u, 100u}) {
    const RadiositySolution s = solveByShooting(own.system(), {.shots = shots});
    EXPECT_EQ(s.steps, shots);
    double mean = 0;
    for (std::size_t i = 0; i < own.area.size(); ++i)
      mean += static_cast<double>(own.area[i]) / area * (s.radiosity[i].x + 0.75 * s.ambient.x);
    EXPECT_NEAR(mean, 8, 0.05);
    EXPECT_LT(s.radiosity[0].x, 7);
  }
}

TEST(RadiositySystem, BitsDoNotDependOnThreads) {
  const made::Patched room(made::colouredRoom(true), 32);
  const Owned own = ofScene(room, 2, 64);
  for (const int bounces : {-1, 5}) {
    const RadiositySolution all = solveByGathering(own.system(), {.bounces = bounces});
    const ThreadLimit limit(1);
    EXPECT_EQ(all.radiosity, solveByGathering(own.system(), {.bounces = bounces}).radiosity);
  }
}

}  // namespace
}  // namespace relume::transport
