// SPDX-License-Identifier: MIT
#include "relume/transport/light_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lit_scene.h"
#include "made_rooms.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume::transport {
namespace {

LightPathOptions small() {
  LightPathOptions options;
  options.materials = Materials::kLambert;
  options.entries = 128, options.elements = 1024, options.exit_side = 4, options.tile_exits = 64;
  options.exit_rays = 256, options.element_rays = 256;
  return options;
}

struct Solved : made::Lit {
  explicit Solved(scene::Scene the_scene, const LightPathOptions& options = small(), int page_size = 96)
      : Lit(std::move(the_scene), page_size), paths(tracer, atlas, texels, options, silent) {}
  SilentProgress silent;
  LightPaths paths;

  std::size_t rowsOf(std::size_t tile) const {
    return paths.tiles().first[tile + 1] - paths.tiles().first[tile];
  }
  /// shape: [rows of tile][3][entries]
  std::vector<float> rows(std::size_t tile) const {
    std::vector<float> out(rowsOf(tile) * 3 * paths.entries().size());
    paths.rows(tile, out);
    return out;
  }
  /// T for every exit, [exits][3][entries]; the tiles that hold an exit agree on its row.
  std::vector<float> transfer() const {
    const std::size_t size = 3 * paths.entries().size();
    std::vector<float> all(paths.exits().size() * size, kInfinity);
    for (std::size_t t = 0; t < paths.tiles().size(); ++t) {
      const std::vector<float> of = rows(t);
      for (std::size_t r = 0; r < rowsOf(t); ++r) {
        float* at = all.data() + paths.tiles().row[paths.tiles().first[t] + r] * size;
        if (at[0] < kInfinity) {
          EXPECT_TRUE(std::equal(at, at + size, of.data() + r * size));
        }
        std::copy_n(of.data() + r * size, size, at);
      }
    }
    return all;
  }
};

Light pointLight(Point p) {
  Light light;
  light.position = p;
  return light;
}

TEST(LightPaths, ExitsCoverTexelsAndTilesBlendToOne) {
  const Solved room(made::colouredRoom(true));
  const Exits& exits = room.paths.exits();
  ASSERT_EQ(exits.of_texel.size(), room.texels.points.size());
  double area = 0, expected = 0;
  for (const Exit& e : exits.all) area += static_cast<double>(e.area);
  for (const atlas::SurfacePoint& p : room.texels.points) expected += static_cast<double>(p.area);
  EXPECT_LT(area, expected * 1.0001);
  EXPECT_GT(area, expected * 0.97);  // the block's foot on the floor is buried
  for (std::size_t i = 0; i < exits.of_texel.size(); ++i) {
    const Exit& e = exits.all[exits.of_texel[i]];
    EXPECT_EQ(e.chart, room.texels.points[i].chart);
    EXPECT_EQ(e.x, room.texels.points[i].texel % 96 / 4);
  }
  const ExitTiles& tiles = room.paths.tiles();
  std::vector<double> sum(exits.size(), 0.0);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    EXPECT_TRUE(std::is_sorted(tiles.row.begin() + tiles.first[t], tiles.row.begin() + tiles.first[t + 1]));
    for (std::size_t k = tiles.first[t]; k < tiles.first[t + 1]; ++k) {
      EXPECT_GT(tiles.blend[k], 0.0f);
      sum[tiles.row[k]] += static_cast<double>(tiles.blend[k]);
    }
  }
  for (const double s : sum) EXPECT_NEAR(s, 1.0, 1e-5);
  EXPECT_NEAR(static_cast<double>(tiles.row.size()) / static_cast<double>(exits.size()), 1.3, 0.02);
}

TEST(LightPaths, EntriesPartTheSurface) {
  const Solved room(made::colouredRoom(false));
  const Entries& entries = room.paths.entries();
  EXPECT_GE(entries.size(), 100u);
  EXPECT_LE(entries.size(), 140u);
  EXPECT_NEAR(static_cast<double>(entries.patches()), 64, 5);
  EXPECT_NEAR(std::accumulate(entries.area.begin(), entries.area.end(), 0.0), 24.0, 0.05);  // by rays
  const float mean = 24.0f / static_cast<float>(entries.patches());
  for (std::size_t p = 0; p < entries.patches(); ++p) {
    const std::uint32_t e = entries.first[p];  // its mean
    const float area = entries.area[e] * static_cast<float>(entries.first[p + 1] - e);
    EXPECT_GT(area, 0.3f * mean);
    EXPECT_LT(area, 2.0f * mean);
    for (std::uint32_t k = 0; k < entries.samples_each; ++k) {
      const EntrySample& s = entries.samples[p * entries.samples_each + k];
      EXPECT_GT(glm::dot(s.normal, entries.normal[e]), 0.99f) << e;
      EXPECT_LT(glm::length(s.position - entries.centre[e]), 1.5f * std::sqrt(mean)) << e;
    }
  }
}

TEST(LightPaths, SamplesOfAnEntryAreItsMean) {
  // The irradiance of a point light on all of a room is its flux, whatever the shape of entries.
  LightPathOptions options = small();
  options.entry_samples = 64;
  const Solved room(made::colouredRoom(false), options);
  SilentProgress silent;
  const LightSet lights = {pointLight({1.1f, 0.8f, 0.9f})};
  const std::vector<float> e = room.paths.entryIrradiance(lights, silent);
  double flux = 0;
  const Entries& entries = room.paths.entries();
  for (std::size_t p = 0; p < entries.patches(); ++p)
    for (std::uint32_t i = entries.first[p]; i < entries.first[p + 1]; ++i)  // which share its area
      flux += static_cast<double>(e[entries.first[p]]) * static_cast<double>(entries.area[i]);
  EXPECT_NEAR(flux, 4 * M_PI, 0.01 * 4 * M_PI);
}

/// The entries where the irradiance is 1 everywhere.
std::vector<double> underEvenLight(const Entries& entries) {
  std::vector<double> e(entries.size(), 0.0);
  for (std::size_t p = 0, at = 0; p < entries.patches(); ++p)
    for (std::uint32_t k = 0; k < entries.samples_each; ++k)
      for (std::uint32_t i = entries.first[p]; i < entries.first[p + 1]; ++i)
        e[i] += static_cast<double>(entries.mix[at++]);
  return e;
}

void expectNoLightLost(std::uint32_t patch_entries, double tolerance) {
  SCOPED_TRACE(patch_entries);
  // E = 1 everywhere: I = rho (1 + I). Even light has not the shape of typical light, so this is not exact.
  const float rho = 0.75f;
  LightPathOptions options = small();
  options.patch_entries = patch_entries;
  const Solved furnace(made::box({4, 3, 2.5f}, Vec3(rho), Vec3(0)), options, 64);
  const std::vector<float> t = furnace.transfer();
  const std::vector<double> e = underEvenLight(furnace.paths.entries());
  const std::size_t rows = t.size() / e.size();
  double mean = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const double sum = std::inner_product(e.begin(), e.end(), &t[row * e.size()], 0.0);
    EXPECT_NEAR(sum, rho / (1 - rho), tolerance * rho / (1 - rho)) << row;
    mean += sum / static_cast<double>(rows);
  }
  EXPECT_NEAR(mean, rho / (1 - rho), 0.01 * rho / (1 - rho));
}

TEST(LightPaths, LosesNoLightInAFurnace) {
  expectNoLightLost(1, 0.02);
  expectNoLightLost(4, 0.07);  // patches four times as large, of whose modes those of lamps come first
}

TEST(LightPaths, RowsTimesIrradianceIsIrradiance) {
  const Solved room(made::colouredRoom(true));
  SilentProgress silent;
  LightSet lights = {pointLight({1.1f, 0.5f, 1.2f}), pointLight({0.6f, 0.6f, 0.4f})};
  lights[1].colour = {0.5f, 2.0f, 1.0f};
  const std::vector<float> e = room.paths.entryIrradiance(lights, silent);
  const std::vector<Irradiance> expected = room.paths.irradiance(lights, LitBy::kEntries, silent);
  const std::vector<float> t = room.transfer();
  const std::size_t entries = room.paths.entries().size(), exits = room.paths.exits().size();
  for (std::size_t l = 0; l < lights.size(); ++l)
    for (std::size_t x = 0; x < exits; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (std::size_t i = 0; i < entries; ++i)
          sum += static_cast<double>(t[(x * 3 + c) * entries + i]) * static_cast<double>(e[l * entries + i]);
        const auto channel = static_cast<int>(c);
        const auto want = static_cast<double>(expected[l * exits + x].rgb[channel]);
        EXPECT_NEAR(sum * static_cast<double>(lights[l].colour[channel]), want, 1e-3 * want + 1e-7);
      }
}

/// Of exits: the truth all over each against what is given, relative to the truth.
struct Comparison {
  double error = 0, noise = 0, bias = 0;
};
Comparison compare(const Solved& solved, const Light& light, std::span<const Irradiance> value,
                   std::size_t every) {
  scene::Scene lit = solved.scene;
  for (scene::Material& m : lit.materials) m.emission = Vec3(0);
  lit.lights = {light};
  const Reference reference(lit);
  // Means over exits: places all over their texels.
  std::vector<Receiver> receivers;
  std::vector<std::uint32_t> which;
  for (std::uint32_t i = 0; i < solved.texels.points.size(); ++i) {
    const atlas::SurfacePoint& p = solved.texels.points[i];
    const std::uint32_t exit = solved.paths.exits().of_texel[i];
    if (exit % every != 0 || solved.paths.exits().buried[i]) continue;
    which.push_back(exit);
    receivers.push_back(
        {footprintPosition(solved.texels, p, sobol2(i, 9)), p.geometric_normal, p.shading_normal});
  }
  ReferenceOptions options;
  options.samples = 256, options.materials = Materials::kLambert, options.part = Part::kIndirect;
  SilentProgress silent;
  const ReferenceIrradiance truth = reference.irradiance(receivers, options, silent);
  std::vector<glm::dvec3> sum(solved.paths.exits().size(), glm::dvec3(0)), variance = sum;
  std::vector<int> count(sum.size(), 0);
  for (std::size_t k = 0; k < which.size(); ++k) {
    const glm::dvec3 e(truth.error[k].rgb);
    sum[which[k]] += glm::dvec3(truth.value[k].rgb), variance[which[k]] += e * e, ++count[which[k]];
  }
  double difference = 0, noise = 0, all = 0, given = 0, truth_sum = 0;
  for (std::size_t x = 0; x < sum.size(); ++x) {
    if (count[x] < 8) continue;  // rims, where texels differ in area
    const glm::dvec3 t = sum[x] / static_cast<double>(count[x]), d = glm::dvec3(value[x].rgb) - t;
    difference += glm::dot(d, d), all += glm::dot(t, t);
    given += d.x + d.y + d.z + t.x + t.y + t.z, truth_sum += t.x + t.y + t.z;
    noise += (variance[x].x + variance[x].y + variance[x].z) / count[x] / count[x];
  }
  return {std::sqrt(std::max(difference - noise, 0.0) / all), std::sqrt(noise / all), given / truth_sum - 1};
}

TEST(LightPaths, AgreesWithTheReference) {
  LightPathOptions options = small();
  options.entries = 512, options.elements = 4096, options.exit_rays = 1024, options.element_rays = 512;
  const Solved room(made::colouredRoom(true), options);
  SilentProgress silent;
  const LightSet lights = {pointLight({1.2f, 0.7f, 1.1f})};
  const auto by_elements = room.paths.irradiance(lights, LitBy::kElements, silent),
             by_entries = room.paths.irradiance(lights, LitBy::kEntries, silent);
  const Comparison elements = compare(room, lights[0], by_elements, 7),
                   entries = compare(room, lights[0], by_entries, 7);
  EXPECT_LT(elements.noise, 0.02);
  EXPECT_LT(elements.error, 0.012);
  EXPECT_LT(entries.error, 0.025);
}

TEST(LightPaths, GroupsThatAreHalfHiddenLoseNoLight) {
  // Low stools: of the floor that an entry or an element covers, the light is on what the room sees.
  scene::Scene scene = made::box({2, 2, 2}, Vec3(0.7f), Vec3(0));
  scene::Mesh stools;
  for (int x = 0; x < 4; ++x)
    for (int z = 0; z < 4; ++z) {
      const Vec3 at(0.1f + 0.5f * static_cast<float>(x), 0.05f, 0.1f + 0.5f * static_cast<float>(z));
      made::addBox(stools, at, at + Vec3(0.3f, 0.05f, 0.3f));
    }
  made::addMaterial(scene, Vec3(0.7f));
  made::addInstance(scene, std::move(stools), 6);
  LightPathOptions options = small();
  options.entries = 48, options.elements = 512;
  const Solved room(std::move(scene), options);
  SilentProgress silent;
  const LightSet lights = {pointLight({0.9f, 1.2f, 1.1f})};
  const Comparison elements =
                       compare(room, lights[0], room.paths.irradiance(lights, LitBy::kElements, silent), 3),
                   entries =
                       compare(room, lights[0], room.paths.irradiance(lights, LitBy::kEntries, silent), 3);
  EXPECT_NEAR(elements.bias, 0, 0.005);  // without shapes -0.0071
  EXPECT_NEAR(entries.bias, 0, 0.02);
}

TEST(LightPaths, BacksReflectToo) {
  // A screen that stands in the room and shows its back to the lamp: what it reflects is most of what falls
  // on the wall behind the lamp.
  scene::Scene scene = made::box({2, 2, 2}, Vec3(0.05f), Vec3(0));
  made::addRoomFace(scene, Vec3(0.9f), {1.2f, 0.3f, 0.3f}, {0, 1.4f, 0}, {0, 0, 1.4f});
  scene.materials.back().double_sided = true;
  LightPathOptions options = small();
  options.entries = 256, options.elements = 2048, options.exit_rays = 1024;
  const Solved room(std::move(scene), options);
  SilentProgress silent;
  const LightSet lights = {pointLight({0.6f, 1, 1})};
  const auto value = room.paths.irradiance(lights, LitBy::kElements, silent);
  EXPECT_LT(compare(room, lights[0], value, 5).error, 0.02);
}

TEST(LightPaths, WallsPartEntries) {
  // One floor and one ceiling for two rooms with a thin wall between them: what falls on one room does not
  // show in the other.
  scene::Scene scene = made::box({4, 2, 2}, Vec3(0.6f), Vec3(0));
  scene::Mesh wall;
  made::addBox(wall, {1.97f, 0, 0}, {2.03f, 2, 2});
  made::addMaterial(scene, Vec3(0.6f));
  made::addInstance(scene, std::move(wall), 6);
  const Solved rooms(std::move(scene));
  const Entries& entries = rooms.paths.entries();
  for (std::size_t p = 0; p < entries.patches(); ++p) {
    bool left = false, right = false;
    for (std::uint32_t k = 0; k < entries.samples_each; ++k) {
      const float x = entries.samples[p * entries.samples_each + k].position.x;
      left |= x<1.9f, right |= x> 2.1f;  // texels are 0.08 m and may lie on both sides
    }
    EXPECT_FALSE(left && right) << p;
  }
  SilentProgress silent;
  const LightSet lights = {pointLight({0.7f, 1, 1})};
  const auto value = rooms.paths.irradiance(lights, LitBy::kEntries, silent);
  double lit = 0, dark = 0;
  for (std::size_t x = 0; x < value.size(); ++x) {
    const float at = rooms.paths.exits().all[x].position.x;
    if (at < 1.8f) lit = std::max(lit, static_cast<double>(value[x].rgb.x));
    if (at > 2.2f) dark = std::max(dark, static_cast<double>(value[x].rgb.x));
  }
  EXPECT_LT(dark, 1e-3 * lit);
}

TEST(LightPaths, BitsDoNotDependOnThreads) {
  const Solved all(made::colouredRoom(true));
  const ThreadLimit limit(1);
  const Solved one(made::colouredRoom(true));
  EXPECT_EQ(all.rows(0), one.rows(0));
  EXPECT_EQ(all.paths.tiles().row, one.paths.tiles().row);
  EXPECT_EQ(all.paths.entries().area, one.paths.entries().area);
}

TEST(LightPaths, LightsStandInFreeSpace) {
  LightPathOptions options = small();
  const Solved room(made::colouredRoom(true), options);
  SilentProgress silent;
  const LightSet lights = room.paths.lights(100, {.nearest = 0.2f, .spots = 0.5f}, 3, silent);
  ASSERT_EQ(lights.size(), 100u);
  std::size_t spots = 0;
  for (const Light& l : lights) {
    spots += l.kind == Light::Kind::kSpot;
    for (int a = 0; a < 3; ++a) {
      EXPECT_GT(l.position[a], 0.19f);
      EXPECT_LT(l.position[a], 1.81f);
    }
    // The block, { .35, 1, 0 } to { .95, 1.6, 1.2 }.
    const Vec3 outside = glm::max(Vec3(0.35f, 1, 0) - l.position, l.position - Vec3(0.95f, 1.6f, 1.2f));
    EXPECT_GT(glm::length(glm::max(outside, Vec3(0))), 0.18f);
  }
  EXPECT_GT(spots, 30u);
  EXPECT_LT(spots, 70u);
  EXPECT_TRUE(room.paths.lights(10, {.nearest = 3.0f}, 3, silent).empty());
  for (const Light& l : room.paths.lights(20, {.nearest = 0.05f, .farthest = 0.1f}, 3, silent)) {
    const Vec3 wall = glm::min(l.position, Vec3(2) - l.position);
    EXPECT_TRUE(std::min({wall.x, wall.y, wall.z}) < 0.11f || l.position.z < 1.31f);
  }
}

TEST(LightPaths, LightsKeepToTheirBoxes) {
  LightPathOptions options = small();
  options.light_boxes = {{{0.1f, 0.1f, 1.5f}, {0.4f, 0.4f, 1.9f}}, {{1.5f, 0.5f, 0.5f}, {1.9f, 1.5f, 1.0f}}};
  const Solved room(made::colouredRoom(false), options);
  SilentProgress silent;
  int in_second = 0;
  const LightSet lights = room.paths.lights(64, {.nearest = 0.01f}, 3, silent);
  ASSERT_EQ(lights.size(), 64u);
  for (const Light& l : lights) {
    const auto inside = [&](const Box3& b) { return b.distance(l.position) == 0.0f; };
    EXPECT_TRUE(inside(options.light_boxes[0]) || inside(options.light_boxes[1]));
    in_second += inside(options.light_boxes[1]);
  }
  EXPECT_GT(in_second, 45);  // 0.2 of 0.236 m^3
}

TEST(LightPaths, RefusesOptionsThatMakeNoSense) {
  const made::Lit room(made::colouredRoom(false), 32);
  SilentProgress silent;
  const auto refused = [&](auto change) {
    LightPathOptions options = small();
    change(options);
    try {
      const LightPaths paths(room.tracer, room.atlas, room.texels, options, silent);
    } catch (const Error& e) {
      return e.code() == ErrorCode::kUsage;
    }
    return false;
  };
  EXPECT_TRUE(refused([](auto& o) { o.entries = 0; }));
  EXPECT_TRUE(refused([](auto& o) { o.patch_entries = 0; }));
  EXPECT_TRUE(refused([](auto& o) { o.elements = 1u << 20; }));
  EXPECT_TRUE(refused([](auto& o) { o.exit_side = 65; }));
  EXPECT_TRUE(refused([](auto& o) { o.exit_rays = 0; }));
  EXPECT_TRUE(refused([](auto& o) { o.tile_overlap = -1; }));
  EXPECT_FALSE(refused([](auto&) {}));
}

}  // namespace
}  // namespace relume::transport
