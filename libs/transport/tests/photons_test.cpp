// SPDX-License-Identifier: MIT
// Light tracing: the balance of its flux, closed forms, and the gathering solver, which shares nothing with
// it but rays and materials. Statistical bounds are 4.5 standard errors where one number is compared (false
// alarms: 7 in a million).
#include "relume/transport/photons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lit_scene.h"
#include "made_rooms.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

using made::Lit;
using Shape = PhotonKernel::Shape;

PhotonOptions shot(std::uint64_t paths, Shape shape = Shape::kBox) {
  return {.paths = paths, .materials = Materials::kLambert, .kernel = {.shape = shape}};
}

PhotonResult solve(const Lit& lit, const PhotonOptions& options) {
  SilentProgress silent;
  return tracePhotons(lit.tracer, lit.atlas, lit.texels, options, silent);
}

/// Every kind of light over a room of every kind of reflection.
scene::Scene everythingThatShines() {
  scene::Scene scene = made::colouredRoom(true);
  scene.materials[0].metallic = 0.7f, scene.materials[0].roughness = 0.3f;
  scene.environment.radiance = Radiance(0.1f);
  const auto add = [&](Light::Kind kind, float intensity) -> Light& {
    Light& light = scene.lights.emplace_back();
    light.kind = kind, light.intensity = intensity, light.position = {0.4f, 0.3f, 0.5f};
    light.direction = glm::normalize(Vec3(0.2f, -0.3f, -1));
    return light;
  };
  add(Light::Kind::kPoint, 2).range = 1.5f;
  add(Light::Kind::kSpot, 5).inner_cone = 0.3f;
  add(Light::Kind::kDirectional, 1).angular_radius = 0.05f;
  Light& disk = add(Light::Kind::kArea, 3);
  disk.area = 0.02f, disk.two_sided = true;
  return scene;
}

TEST(Photons, FluxIsInBalanceToTheLastUnit) {
  const Lit room(everythingThatShines(), 64);
  PhotonOptions options = shot(200000);
  options.materials = Materials::kFull;
  const PhotonResult result = solve(room, options);
  const PhotonBalance& b = result.balance;
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(b.shot[c] + b.reflected[c], b.landed[c] + b.escaped[c] + b.faded[c]);
    EXPECT_EQ(b.landed[c], b.deposited[c] + b.elsewhere[c]);  // surfaces are flat: nothing turns
    std::int64_t sum = 0;
    for (std::size_t i = c; i < result.flux.size(); i += 3) sum += result.flux[i];
    EXPECT_EQ(sum, b.deposited[c]);
    EXPECT_GT(b.escaped[c], 0);
    EXPECT_GT(b.faded[c], 0);
    EXPECT_GT(b.reflected[c], 0);
  }
}

TEST(Photons, BitsDoNotDependOnThreads) {
  const Lit room(everythingThatShines(), 32);
  PhotonOptions options = shot(50000, Shape::kAdaptive);
  options.materials = Materials::kFull, options.receiver = basis::makeBasis("sh2");
  const PhotonResult many = solve(room, options);
  const ThreadLimit one(1);
  const PhotonResult single = solve(room, options);
  EXPECT_EQ(many.flux, single.flux);
  EXPECT_EQ(many.sums, single.sums);
  for (std::size_t i = 0; i < many.value.size(); ++i) ASSERT_EQ(many.value[i], single.value[i]);
}

double meanOf(const Lit& lit, const PhotonResult& result, int c) {
  double flux = 0, area = 0;
  for (std::size_t i = 0; i < lit.texels.points.size(); ++i) {
    const auto a = static_cast<double>(lit.texels.points[i].area);
    flux += a * static_cast<double>(result.value[i].rgb[c]), area += a;
  }
  return flux / area;
}

TEST(Photons, AFurnaceAndItsBounces) {
  // As in lightmap_test.cpp: exitance 2, reflectance 0.75.
  const Lit furnace(made::box({4, 3, 2.5f}, Vec3(0.75f), Vec3(2 / kPi)));
  for (const int bounces : {0, 1, 2, ReferenceOptions::kUnlimited}) {
    PhotonOptions options = shot(200000);
    options.max_bounces = bounces;
    const double exact = bounces < 0 ? 8 : 8 * (1 - std::pow(0.75, bounces + 1));
    // Direct light is all of what is shot; of the rest the number of bounces varies, by less than its square.
    EXPECT_NEAR(meanOf(furnace, solve(furnace, options), 1) / exact, 1,
                bounces == 0 ? 1e-4 : 4.5 / std::sqrt(200000.0));
  }
}

TEST(Photons, ACavityUnderASky) {
  scene::Scene scene = made::cavity(1, std::acos(0.4f), {0.8f, 0.5f, 0.2f});
  scene.environment.radiance = Radiance(1.0f);
  const Lit cavity(std::move(scene), 128);
  const PhotonResult result = solve(cavity, shot(1 << 20));
  const std::array<double, 3> exact = {2.1419949910839495, 1.449965840118366, 1.095904414042951};
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(meanOf(cavity, result, c) / exact[static_cast<std::size_t>(c)], 1, 0.01) << c;
}

/// Where light is even it is even to the rim: no kernel darkens the border of a chart, or a texel of which
/// the chart covers a part.
TEST(Photons, KernelsKeepTheRimsOfCharts) {
  scene::Scene scene = made::box({4, 3, 2.5f}, Vec3(0.0f), Vec3(1.0f));
  const Lit room(std::move(scene), 32);
  for (const Shape shape : {Shape::kBox, Shape::kPyramid, Shape::kAdaptive}) {
    const PhotonResult result = solve(room, shot(1 << 20, shape));
    double rim = 0, rim_area = 0;
    for (std::size_t i = 0; i < room.texels.points.size(); ++i) {
      const atlas::SurfacePoint& p = room.texels.points[i];
      if (p.coverage > 0.99f) continue;
      rim += static_cast<double>(p.area * result.value[i].rgb.x), rim_area += static_cast<double>(p.area);
    }
    ASSERT_GT(rim_area, 0);
    EXPECT_NEAR(rim / rim_area / M_PI, 1, 0.01) << static_cast<int>(shape);
  }
}

/// Texel by texel: the differences to gathered light are what both errors say, without a bias. The median of
/// their squares, because under a block a texel's gathered value is that of the part that can be seen.
void expectAgreement(const Lit& room, Materials materials) {
  constexpr double kMedian = 0.4549;  // of chi-squared, one degree of freedom
  PhotonOptions photons = shot(1 << 20);
  photons.materials = materials;
  LightmapOptions gather = made::plain(256);
  gather.materials = materials, gather.cache_samples = 64;
  const PhotonResult a = solve(room, photons);
  const LightmapResult b = room.solve(gather);
  std::vector<double> squares;
  double difference = 0, all = 0;
  for (std::size_t i = 0; i < a.value.size(); ++i) {
    const atlas::SurfacePoint& p = room.texels.points[i];
    if (p.coverage < 0.99f || b.back_share[i] > 0.01f) continue;
    const double d = static_cast<double>(luminance(a.value[i].rgb) - luminance(b.value[i].rgb));
    const double e2 =
        std::pow(static_cast<double>(a.error[i]), 2) + std::pow(static_cast<double>(b.error[i]), 2);
    if (!(e2 > 0)) continue;
    squares.push_back(d * d / e2);
    difference += d, all += static_cast<double>(luminance(b.value[i].rgb));
  }
  ASSERT_GT(squares.size(), 500u);
  std::sort(squares.begin(), squares.end());
  EXPECT_NEAR(squares[squares.size() / 2] / kMedian, 1, 0.25);
  const auto far = std::count_if(squares.begin(), squares.end(), [](double s) { return s > 25; });
  EXPECT_LT(static_cast<double>(far), 0.02 * static_cast<double>(squares.size()));
  EXPECT_NEAR(difference / all, 0, 0.01);
}

TEST(Photons, AgreeWithGatheringInARoom) {
  expectAgreement(Lit(made::colouredRoom(false), 64), Materials::kLambert);
}

TEST(Photons, AgreeWithGatheringAboutABlock) {
  scene::Scene scene = made::colouredRoom(true);
  scene.environment.radiance = Radiance(0.2f);
  expectAgreement(Lit(std::move(scene), 64), Materials::kLambert);
}

TEST(Photons, AgreeWithGatheringOnGlossyWalls) {
  scene::Scene scene = made::colouredRoom(false);
  for (scene::Material& m : scene.materials) m.roughness = 0.5f, m.metallic = 0.5f;
  expectAgreement(Lit(std::move(scene), 64), Materials::kFull);
}

/// Directional maps of both solvers, block by block of 8 x 8 texels and direction by direction: the mean of
/// some runs of each, and how much runs differ, which says how much the means may.
void expectSameDirections(const Lit& room, Materials materials) {
  constexpr int kRuns = 8;
  constexpr std::uint32_t kBlock = 8;
  const auto basis = std::shared_ptr<const basis::Basis>(basis::makeBasis("directions:14"));
  const auto width = static_cast<std::uint32_t>(room.texels.width);
  const std::uint32_t across = width / kBlock, blocks = across * across * room.texels.pages;
  std::vector<double> area(blocks, 0.0);
  const auto blockOf = [&](const atlas::SurfacePoint& p) {
    const std::uint32_t page = p.texel / (width * width), in_page = p.texel % (width * width);
    return (page * across + in_page / width / kBlock) * across + in_page % width / kBlock;
  };
  for (const atlas::SurfacePoint& p : room.texels.points) area[blockOf(p)] += static_cast<double>(p.area);
  struct Moments {
    std::vector<double> sum, squares;
  };
  const auto measured = [&](const auto& sums_of_run) {
    Moments m{std::vector<double>(blocks * 14, 0.0), std::vector<double>(blocks * 14, 0.0)};
    for (int run = 0; run < kRuns; ++run) {
      const std::vector<float> sums = sums_of_run(static_cast<std::uint64_t>(run + 1));
      std::vector<double> block(blocks * 14, 0.0);
      for (std::size_t i = 0; i < room.texels.points.size(); ++i)
        for (std::size_t d = 0; d < 14; ++d)
          block[blockOf(room.texels.points[i]) * 14 + d] +=
              static_cast<double>(room.texels.points[i].area * sums[i * 42 + d * 3 + 1]);
      for (std::size_t k = 0; k < block.size(); ++k)
        m.sum[k] += block[k] / kRuns, m.squares[k] += block[k] * block[k] / kRuns;
    }
    return m;
  };
  const Moments photons = measured([&](std::uint64_t seed) {
    PhotonOptions options = shot(1 << 19);
    options.materials = materials, options.receiver = basis, options.seed = seed;
    return solve(room, options).sums;
  });
  const Moments gathered = measured([&](std::uint64_t seed) {
    LightmapOptions options = made::plain(64);
    options.materials = materials, options.receiver = basis, options.seed = seed, options.cache_samples = 64;
    return room.solve(options).sums;
  });
  const auto variance = [](const Moments& m, std::size_t k) {
    return std::max(m.squares[k] - m.sum[k] * m.sum[k], 0.0) / (kRuns - 1);
  };
  double total = 0, chi = 0;
  for (const double s : photons.sum) total += s;
  std::size_t n = 0;
  for (std::size_t k = 0; k < photons.sum.size(); ++k) {
    const double d = photons.sum[k] - gathered.sum[k];
    // Besides, the cache of gathering has an error of its own, half a percent of the block's light.
    double light = 0;
    for (std::size_t j = k / 14 * 14; j < k / 14 * 14 + 14; ++j) light += photons.sum[j];
    const double e2 = variance(photons, k) + variance(gathered, k) + 2.5e-5 * light * light;
    if (photons.sum[k] + gathered.sum[k] < 1e-5 * total) continue;
    chi += d * d / e2, ++n;
  }
  ASSERT_GT(n, 300u);
  // Student's t with 7 degrees of freedom has a variance of 7/5.
  EXPECT_LT(chi / static_cast<double>(n), 2.0);
}

TEST(Photons, DirectionsAgreeWithGatheringInARoom) {
  expectSameDirections(Lit(made::colouredRoom(false), 64), Materials::kLambert);
}

TEST(Photons, DirectionsAgreeWithGatheringUnderASky) {
  scene::Scene scene = made::cavity(1, std::acos(0.4f), {0.8f, 0.5f, 0.2f});
  scene.environment.radiance = Radiance(1.0f);
  expectSameDirections(Lit(std::move(scene), 64), Materials::kLambert);
}

TEST(Photons, DirectionsAgreeWithGatheringOnGlossyWalls) {
  scene::Scene scene = made::colouredRoom(false);
  for (scene::Material& m : scene.materials) m.roughness = 0.5f, m.metallic = 0.5f;
  expectSameDirections(Lit(std::move(scene), 64), Materials::kFull);
}

}  // namespace
}  // namespace relume::transport
