// SPDX-License-Identifier: MIT
// Exits at vertices and at probes.
#include "light_paths/point_exits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "lit_scene.h"
#include "made_rooms.h"
#include "relume/basis/sh9.h"
#include "relume/core/error.h"
#include "relume/transport/light_paths.h"

namespace relume::transport {
namespace {

LightPathOptions small(Receivers receivers) {
  LightPathOptions options;
  options.materials = Materials::kLambert, options.receivers = receivers;
  options.entries = 128, options.elements = 1024, options.exit_rays = 1024, options.element_rays = 256;
  options.probe_spacing = 0.8f;
  options.patch_entries = 1;  // of which all are 1 under even light
  return options;
}

/// Sums over entries by [exits * rows_each][3]: irradiance where all entries have 1.
std::vector<double> underLightOfOne(const LightPaths& paths) {
  const std::size_t each = paths.exits().rows_each * 3, entries = paths.entries().size();
  std::vector<double> sums(paths.exits().size() * each, -1.0);
  for (std::size_t t = 0; t < paths.tiles().size(); ++t) {
    const std::size_t first = paths.tiles().first[t], count = paths.tiles().first[t + 1] - first;
    std::vector<float> rows(count * each * entries);
    paths.rows(t, rows);
    for (std::size_t r = 0; r < count * each; ++r) {
      const auto at = rows.begin() + static_cast<std::ptrdiff_t>(r * entries);
      sums[paths.tiles().row[first + r / each] * each + r % each] =
          std::accumulate(at, at + static_cast<std::ptrdiff_t>(entries), 0.0);
    }
  }
  return sums;
}

TEST(VertexExits, OneForEachPlaceAndNormal) {
  const made::Lit room(made::box({2, 3, 4}, Vec3(0.5f), Vec3(0)));
  const PointExits points = vertexExits(room.scene, room.atlas, room.texels);
  ASSERT_EQ(points.exits.size(), 24u);  // four of each wall
  double area = 0;
  for (const Exit& e : points.exits.all) area += static_cast<double>(e.area);
  EXPECT_NEAR(area, 52, 1e-4);
  ASSERT_EQ(points.exits.vertices_of_texel.size(), room.texels.points.size());
  for (std::size_t i = 0; i < room.texels.points.size(); ++i) {
    const TexelVertices& t = points.exits.vertices_of_texel[i];
    Point p(0);
    for (std::size_t k = 0; k < 3; ++k) {
      const Exit& e = points.exits.all[t.exit[k]];
      p += t.weight[static_cast<int>(k)] * e.position;
      EXPECT_EQ(e.normal, room.texels.points[i].shading_normal);
    }
    EXPECT_LT(glm::length(p - room.texels.points[i].position), 1e-4f) << i;
  }
}

TEST(VertexExits, AFurnaceIsExact) {
  const float rho = 0.75f;
  const made::Lit furnace(made::box({4, 3, 2.5f}, Vec3(rho), Vec3(0)));
  SilentProgress silent;
  const LightPaths paths(furnace.tracer, furnace.atlas, furnace.texels, small(Receivers::kVertices), silent);
  // Shapes of groups (typical_light.h) are not even, and rays that begin near corners see few groups.
  for (const double sum : underLightOfOne(paths)) EXPECT_NEAR(sum, rho / (1 - rho), 0.01 * rho / (1 - rho));
}

TEST(ProbeExits, AFurnaceIsExact) {
  // Radiance I / pi from everywhere: irradiance I along every normal.
  const float rho = 0.75f;
  const made::Lit furnace(made::box({4, 3, 2.5f}, Vec3(rho), Vec3(0)));
  SilentProgress silent;
  const LightPaths paths(furnace.tracer, furnace.atlas, furnace.texels, small(Receivers::kProbes), silent);
  const ProbeGrid& grid = paths.exits().grid;
  EXPECT_EQ(grid.count, UVec3(5, 4, 4));
  EXPECT_EQ(paths.exits().size(), 80u);
  const std::vector<double> sums = underLightOfOne(paths);
  for (const Direction n : {Direction(1, 0, 0), Direction(0, 0, -1), glm::normalize(Vec3(1, 2, 3))}) {
    const auto y = basis::sh9(n);
    for (std::size_t probe = 0; probe < paths.exits().size(); ++probe) {
      double e = 0;
      for (std::size_t k = 0; k < 9; ++k) e += sums[(probe * 9 + k) * 3] * static_cast<double>(y[k]);
      EXPECT_NEAR(e, rho / (1 - rho), 0.01 * rho / (1 - rho));  // rays, band 1 and 2
    }
  }
}

TEST(ProbeExits, StandInTheAir) {
  const made::Lit room(made::colouredRoom(true));
  const PointExits points = probeExits(room.tracer, {Point(-0.5f), Point(2.5f)}, 0.25f);
  for (const Exit& e : points.exits.all) {
    EXPECT_TRUE(glm::all(glm::greaterThan(e.position, Vec3(0))) &&
                glm::all(glm::lessThan(e.position, Vec3(2))));
    EXPECT_FALSE(e.position.x > 0.35f && e.position.x < 0.95f && e.position.y > 1 && e.position.y < 1.6f &&
                 e.position.z < 1.2f);
  }
  EXPECT_GT(points.exits.size(), 400u);
  try {
    probeExits(room.tracer, {Point(0), Point(2)}, 1e-3f);
    FAIL() << "eight thousand million probes";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kUsage);
  }
}

/// Path tracing of the room under these lights alone.
Reference litBy(made::Lit& room, const LightSet& lights) {
  for (scene::Material& m : room.scene.materials) m.emission = Vec3(0);
  room.scene.lights = lights;
  return Reference(room.scene);
}

/// Indirect irradiance at exits beside path tracing, relative to its mean.
TEST(ProbeExits, AgreeWithTheReference) {
  made::Lit room(made::colouredRoom(false), 96);
  LightPathOptions options = small(Receivers::kProbes);
  options.entries = 512, options.elements = 4096;
  SilentProgress silent;
  const LightPaths paths(room.tracer, room.atlas, room.texels, options, silent);
  Light lamp;
  lamp.position = {1.2f, 0.7f, 1.1f};
  const LightSet lights = {lamp};
  const std::vector<Irradiance> c = paths.irradiance(lights, LitBy::kEntries, silent);
  const Reference reference = litBy(room, lights);
  std::vector<Receiver> receivers;
  for (const Exit& e : paths.exits().all)
    for (const Direction n : {Direction(1, 0, 0), Direction(-1, 0, 0), Direction(0, 0.6f, 0.8f)})
      receivers.push_back({e.position, n, n});
  const auto truth = reference.irradiance(
      receivers, {.samples = 4096, .materials = Materials::kLambert, .part = Part::kIndirect}, silent);
  double error = 0, all = 0;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const auto y = basis::sh9(receivers[i].geometric_normal);
    Vec3 e(0);
    for (std::size_t k = 0; k < 9; ++k) e += y[k] * c[i / 3 * 9 + k].rgb;
    const Vec3 d = e - truth.value[i].rgb;
    error += static_cast<double>(glm::dot(d, d));
    all += static_cast<double>(glm::dot(truth.value[i].rgb, truth.value[i].rgb));
  }
  EXPECT_LT(std::sqrt(error / all), 0.04);  // what nine coefficients leave out, and entries
}

TEST(VertexExits, AgreeWithTheReferenceInsideAWall) {
  // A floor of 16 x 16 quads: vertices away from the walls.
  scene::Scene scene = made::colouredRoom(false);
  made::addMaterial(scene, Vec3(0.5f));
  scene::Mesh mesh;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      made::addQuad(mesh,
                    {0.5f + 0.125f * static_cast<float>(i), 0.5f + 0.125f * static_cast<float>(j), 0.4f},
                    {0.125f, 0, 0}, {0, 0.125f, 0});
  made::addInstance(scene, std::move(mesh), static_cast<std::uint32_t>(scene.materials.size()) - 1);
  made::Lit room(std::move(scene), 96);
  LightPathOptions options = small(Receivers::kVertices);
  options.entries = 512, options.elements = 4096;
  SilentProgress silent;
  const LightPaths paths(room.tracer, room.atlas, room.texels, options, silent);
  Light lamp;
  lamp.position = {1.2f, 0.7f, 1.3f};
  const LightSet lights = {lamp};
  const std::vector<Irradiance> got = paths.irradiance(lights, LitBy::kElements, silent);
  const Reference reference = litBy(room, lights);
  std::vector<Receiver> receivers;
  std::vector<std::size_t> which;
  for (std::size_t x = 0; x < paths.exits().size(); ++x) {
    const Exit& e = paths.exits().all[x];
    if (std::abs(e.position.z - 0.4f) > 1e-3f || e.normal.z < 0.5f) continue;
    receivers.push_back({e.position, e.normal, e.normal}), which.push_back(x);
  }
  ASSERT_EQ(which.size(), 81u);
  const auto truth = reference.irradiance(
      receivers, {.samples = 4096, .materials = Materials::kLambert, .part = Part::kIndirect}, silent);
  double error = 0, all = 0;
  for (std::size_t i = 0; i < which.size(); ++i) {
    const Vec3 d = got[which[i]].rgb - truth.value[i].rgb;
    error += static_cast<double>(glm::dot(d, d));
    all += static_cast<double>(glm::dot(truth.value[i].rgb, truth.value[i].rgb));
  }
  EXPECT_LT(std::sqrt(error / all), 0.04);
}

}  // namespace
}  // namespace relume::transport
