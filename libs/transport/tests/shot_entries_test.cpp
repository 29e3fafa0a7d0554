// SPDX-License-Identifier: MIT
// Entry points shot from test points: their density against closed forms, and what LightPaths makes of them.
// A statistical test fails by chance once in 15,000 runs (4 standard errors) with random rays;
// low-discrepancy ones keep much closer, and seeds are fixed.
#include "light_paths/shot_entries.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "lit_scene.h"
#include "made_rooms.h"
#include "relume/core/error.h"
#include "relume/core/quantity.h"
#include "relume/transport/light_paths.h"

namespace relume::transport {
namespace {

/// Recorded too: docs/validation.md is made from it.
void expectExact(const std::string& id, double measured, double exact, double tolerance) {
  testing::Test::RecordProperty(id, fmt::format("{:.6f} {:.6f}", measured, exact));
  EXPECT_NEAR(measured, exact, tolerance) << id;
}

std::vector<ShotEntry> shoot(const trace::Tracer& tracer, const ShotRays& rays) {
  SilentProgress silent;
  return shootEntries(tracer, rays, 1, silent);
}

TEST(ShotEntries, DensityInABox) {
  const scene::Scene scene = made::box({4, 3, 2.5f}, Vec3(0.5f), Vec3(0));
  const trace::Tracer tracer(scene);
  const ShotRays rays{.from = {{1.0f, 1.2f, 2.0f}, {3.1f, 2.2f, 0.6f}}, .each = 10000, .aim = {}};
  expectExact("entry.density.0", static_cast<double>(entryDensity(tracer, rays, {2, 1.5f, 0}, {0, 0, 1})),
              300.0818016112279, 1e-3);
  expectExact("entry.density.1", static_cast<double>(entryDensity(tracer, rays, {0, 1, 1}, {1, 0, 0})),
              338.84151935268136, 1e-3);
  const std::vector<ShotEntry> shot = shoot(tracer, rays);
  EXPECT_EQ(shot.size(), 20000u);
  const std::array<double, 6> expected = {2390.0428816374215, 2541.738251234454,  2581.728288448596,
                                          3477.351262056868,  4278.5677004464815, 4730.571616176182};
  std::array<double, 6> hits{};
  double area = 0, square = 0;
  for (const ShotEntry& e : shot) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (std::abs(e.normal[static_cast<int>(axis)]) > 0.5f)
        ++hits[2 * axis + (e.normal[static_cast<int>(axis)] < 0 ? 1 : 0)];
    const double share = 1 / static_cast<double>(e.density);
    area += share, square += share * share;
  }
  for (std::size_t face = 0; face < 6; ++face)
    expectExact(fmt::format("entry.density.face{}", face), hits[face], expected[face],
                4 * std::sqrt(expected[face]));
  EXPECT_NEAR(area, 59.0, 4 * std::sqrt(square));  // the walls
}

TEST(ShotEntries, AimedRaysAreDenserBelow) {
  const scene::Scene scene = made::box({4, 3, 2.5f}, Vec3(0.5f), Vec3(0));
  const trace::Tracer tracer(scene);
  const ShotRays rays{.from = {{2, 1.5f, 2}}, .each = 4096, .aim = Direction(0, 0, -1)};
  // Straight below: 1 / (pi h^2); a metre aside cos^2 / (pi r^2).
  EXPECT_NEAR(entryDensity(tracer, rays, {2, 1.5f, 0}, {0, 0, 1}), 4096 / (M_PI * 4), 1e-2);
  EXPECT_NEAR(entryDensity(tracer, rays, {3, 1.5f, 0}, {0, 0, 1}), 4096 / M_PI * 4 / 25, 1e-2);
  EXPECT_EQ(entryDensity(tracer, rays, {2, 1.5f, 2.5f}, {0, 0, -1}), 0.0f);
  const std::vector<ShotEntry> shot = shoot(tracer, rays);
  EXPECT_EQ(shot.size(), 4096u);
  double below = 0;
  for (const ShotEntry& e : shot) {
    EXPECT_LT(e.position.z, 2.0f);
    below += 1 / static_cast<double>(e.density);
  }
  // The floor, and the walls up to 2 m. Near there 1 / d has no bound, which is what makes the sum noisy.
  EXPECT_NEAR(below, 12 + 2 * 14, 4);
}

TEST(ShotEntries, WhatATestPointDoesNotSeeDoesNotCount) {
  scene::Scene scene = made::box({4, 2, 2}, Vec3(0.5f), Vec3(0));
  made::addRoomFace(scene, Vec3(0.5f), {2, 0, 0}, {0, 2, 0}, {0, 0, 2});
  const trace::Tracer tracer(scene);
  const ShotRays both{.from = {{1, 1, 1}, {3, 1, 1}}, .each = 1000, .aim = {}},
      one{.from = {{1, 1, 1}}, .each = 1000, .aim = {}};
  const float seen = entryDensity(tracer, both, {1, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(seen, 1000 / (4 * M_PI), 1e-2);
  EXPECT_EQ(seen, entryDensity(tracer, one, {1, 1, 0}, {0, 0, 1}));
  EXPECT_EQ(entryDensity(tracer, one, {3, 1, 0}, {0, 0, 1}), 0.0f);
  EXPECT_EQ(entryDensity(tracer, one, {1, 1, 0}, {0, 0, -1}), 0.0f);  // the other side
}

TEST(ShotEntries, CountIsMetInTheOpen) {
  const scene::Scene scene = made::floor();
  const trace::Tracer tracer(scene);
  ShotRays rays{.from = {{0, 0, 0}, {1, 0, 0}}, .each = 1, .aim = {}};  // half of the rays meet nothing
  rays.each = raysForEntries(tracer, rays, 1000, 1);
  EXPECT_NEAR(rays.each, 1000, 60);
  EXPECT_NEAR(static_cast<double>(shoot(tracer, rays).size()), 1000, 60);
  rays.aim = Direction(0, 0, 1);
  EXPECT_EQ(raysForEntries(tracer, rays, 1000, 1), 1u);
  EXPECT_TRUE(shoot(tracer, rays).empty());
}

LightPathOptions shotOptions(Box3 from, std::uint32_t test_points, std::uint32_t entries) {
  LightPathOptions options;
  options.materials = Materials::kLambert;
  options.placement = EntryPlacement::kShot, options.test_points = test_points, options.entries = entries;
  options.elements = 1024, options.exit_side = 4, options.tile_exits = 64;
  options.exit_rays = 256, options.element_rays = 256;
  options.light_boxes = {from};
  return options;
}
Box3 about(Point p, float half) { return {p - half, p + half}; }

TEST(ShotEntries, TransferInASphere) {
  // d, T_e, their sum under a lamp, and I_e / d of a lamp where the test point is.
  const made::Lit sphere(made::cavity(2, 0, Vec3(0.6f)));
  SilentProgress silent;
  constexpr std::uint32_t kEntries = 1024;
  const LightPaths paths(sphere.tracer, sphere.atlas, sphere.texels,
                         shotOptions(about(Point(0), 1e-3f), 1, kEntries), silent);
  const Entries& entries = paths.entries();
  ASSERT_EQ(entries.size(), kEntries);
  ASSERT_EQ(entries.samples_each, 1u);
  const double per_case = 10000.0 / kEntries;  // the case has so many entries
  double area = 0;
  for (const float a : entries.area) area += static_cast<double>(a) / kEntries;
  // The facets lie up to 5e-4 R within the sphere, and their area is 4e-4 smaller.
  expectExact("entry.transfer.sphere.d", per_case / area, 198.94367886486918, 0.2);
  Light lamp;
  lamp.intensity = 10;
  const std::vector<float> lit = paths.entryIrradiance(std::vector<Light>{lamp}, silent);
  std::vector<float> rows(3 * entries.size() * (paths.tiles().first[1] - paths.tiles().first[0]));
  paths.rows(0, rows);
  double transfer = 0, sum = 0;
  const std::size_t count = rows.size() / entries.size();
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const auto t = static_cast<double>(rows[row * entries.size() + e]);
      transfer += t / static_cast<double>(entries.size() * count);
      sum += t * static_cast<double>(lit[e]) / static_cast<double>(count);
    }
  // Entries are a sample of where light may enter; that noise, of the pieces they fall into, is what is left.
  expectExact("entry.transfer.sphere.T_e", transfer / per_case, 0.00015, 0.02 * 0.00015);
  expectExact("entry.transfer.sphere.sum", sum, 3.75, 0.02 * 3.75);

  const trace::Tracer& tracer = sphere.tracer;
  const ShotRays rays{.from = {{0.5f, 0, 0.8f}}, .each = 10000, .aim = {}};
  lamp.position = rays.from[0];
  double largest = 0, smallest = 1;
  for (const ShotEntry& e : shoot(tracer, rays)) {
    const double ratio = static_cast<double>(directIrradiance(lamp, e.position, e.normal).rgb.x) /
                         static_cast<double>(e.density);
    largest = std::max(largest, ratio), smallest = std::min(smallest, ratio);
  }
  expectExact("entry.transfer.sphere.ratio", smallest, 0.012566370614359173, 1e-6);
  expectExact("entry.transfer.sphere.ratio.most", largest, 0.012566370614359173, 1e-6);
}

TEST(ShotEntries, AFurnaceIsRightInTheMean) {
  // All test points' densities together: sum of T over entries is rho / (1 - rho), noise of 1 / d included.
  const float rho = 0.5f;
  const made::Lit furnace(made::box({4, 3, 2.5f}, Vec3(rho), Vec3(0)));
  SilentProgress silent;
  const LightPaths paths(furnace.tracer, furnace.atlas, furnace.texels,
                         shotOptions({{1, 1, 1}, {3, 2, 1.5f}}, 32, 2048), silent);
  double sum = 0, rows_seen = 0;
  for (std::size_t t = 0; t < paths.tiles().size(); ++t) {
    std::vector<float> rows((paths.tiles().first[t + 1] - paths.tiles().first[t]) * 3 *
                            paths.entries().size());
    paths.rows(t, rows);
    sum += std::accumulate(rows.begin(), rows.end(), 0.0);
    rows_seen += static_cast<double>(rows.size() / paths.entries().size());
  }
  EXPECT_NEAR(sum / rows_seen, rho / (1 - rho), 0.03 * rho / (1 - rho));
}

TEST(ShotEntries, LightThatIsWhereTheyWereShotFromIsRight) {
  const made::Lit room(made::colouredRoom(true), 96);
  SilentProgress silent;
  const Point at(1.2f, 0.7f, 1.1f);
  const LightPaths paths(room.tracer, room.atlas, room.texels, shotOptions(about(at, 1e-3f), 1, 2048),
                         silent);
  Light lamp;
  lamp.position = at;
  const LightSet lights = {lamp};
  const auto exact = paths.irradiance(lights, LitBy::kElements, silent),
             shot = paths.irradiance(lights, LitBy::kEntries, silent);
  double error = 0, all = 0, sum = 0, expected = 0;
  for (std::size_t x = 0; x < exact.size(); ++x) {
    const glm::dvec3 d = glm::dvec3(shot[x].rgb) - glm::dvec3(exact[x].rgb), e(exact[x].rgb);
    error += glm::dot(d, d), all += glm::dot(e, e);
    sum += shot[x].rgb.x, expected += exact[x].rgb.x;
  }
  // Rays of an exit meet few of the pieces that have an entry point: noise that patches have not.
  EXPECT_LT(std::sqrt(error / all), 0.06);
  EXPECT_NEAR(sum, expected, 0.01 * expected);
}

TEST(ShotEntries, RoomForTestPointsIsNeeded) {
  const made::Lit room(made::colouredRoom(true), 32);
  SilentProgress silent;
  try {
    const LightPaths paths(room.tracer, room.atlas, room.texels,
                           shotOptions(about({0.6f, 1.3f, 0.5f}, 0.1f), 4, 64), silent);  // inside the block
    FAIL() << "there is room inside a block";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kEmptyScene);
  }
}

}  // namespace
}  // namespace relume::transport
