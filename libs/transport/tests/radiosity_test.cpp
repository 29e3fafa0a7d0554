// SPDX-License-Identifier: MIT
// Lightmaps by radiosity against closed forms, against a radiosity system with exact form factors, and
// against the other solver.
#include "relume/transport/radiosity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "patched_scene.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

using made::expectNear;
using made::Patched;
using FormFactorsOf = RadiosityOptions::FormFactors;
using Solution = RadiosityOptions::Solution;
using Emission = RadiosityOptions::Emission;

LightmapOptions plain(std::uint32_t samples, const RadiosityOptions& radiosity = {}) {
  LightmapOptions options{.materials = Materials::kLambert, .min_samples = samples, .max_samples = samples};
  options.method = LightmapMethod::kRadiosity, options.radiosity = radiosity;
  return options;
}

double rms(const LightmapResult& a, const LightmapResult& b) {
  double sum = 0, all = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.value.size(); ++i) {
    if (b.back_share[i] > 0.25f) continue;
    sum += std::pow(static_cast<double>(luminance(a.value[i].rgb - b.value[i].rgb)), 2);
    all += static_cast<double>(luminance(b.value[i].rgb)), ++count;
  }
  return std::sqrt(sum / static_cast<double>(count)) / (all / static_cast<double>(count));
}

TEST(Radiosity, AFurnaceAndItsBounces) {
  // See lightmap_test.cpp. By patches that emit the form is exact; the last gathering and direct light are
  // what remains.
  const Patched furnace(made::box({4, 3, 2.5f}, Vec3(0.75f), Vec3(2 / kPi)), 32);
  for (const Emission emission : {Emission::kSampled, Emission::kPatches})
    for (const Solution solution : {Solution::kGathering, Solution::kProgressive})
      for (const int bounces : {0, 1, 3, ReferenceOptions::kUnlimited}) {
        LightmapOptions options = plain(64, {.solution = solution, .emission = emission, .rays = 256});
        options.max_bounces = bounces;
        const double exact = bounces < 0 ? 8 : 8 * (1 - std::pow(0.75, bounces + 1));
        expectNear(furnace.mean(furnace.solve(options)), glm::dvec3(exact), 4e-3);
      }
}

TEST(Radiosity, AnIntegratingSphere) {
  scene::Scene scene = made::cavity(2, 0, Vec3(0.6f));
  Light& light = scene.lights.emplace_back();
  light.position = {0.5f, 0, 0.8f}, light.intensity = 10;
  const Patched sphere(std::move(scene));
  LightmapOptions options = plain(64, {.rays = 256});
  options.part = Part::kIndirect;
  expectNear(sphere.mean(sphere.solve(options)), glm::dvec3(3.75), 5e-3);
  options.max_bounces = 1;
  expectNear(sphere.mean(sphere.solve(options)), glm::dvec3(1.5), 5e-3);
}

TEST(Radiosity, ACavityUnderASky) {
  scene::Scene scene = made::cavity(1, std::acos(0.4f), {0.8f, 0.5f, 0.2f});
  scene.environment.radiance = Radiance(1.0f);
  const Patched cavity(std::move(scene));
  expectNear(cavity.mean(cavity.solve(plain(64))), {2.1419949910839495, 1.449965840118366, 1.095904414042951},
             5e-3);
}

TEST(Radiosity, TheColouredRoomAgreesWithExactFormFactors) {
  const Patched room(made::colouredRoom(false), 256);
  const auto compare = [&](const RadiosityOptions& radiosity, double of_total, double of_indirect) {
    LightmapOptions options = plain(128, radiosity);
    std::vector<Point> points;
    for (const made::RoomCase& c : made::kColouredRoom) points.push_back(c.p);
    const auto total = room.solveNear(options, points, 0.05f);
    options.part = Part::kIndirect;
    const auto indirect = room.solveNear(options, points, 0.05f);
    for (const made::RoomCase& c : made::kColouredRoom) {
      expectNear(room.about(total, c.p, c.n, 0.05f), c.total, of_total, "total");
      expectNear(room.about(indirect, c.p, c.n, 0.05f), c.total - c.direct, of_indirect, "indirect");
    }
  };
  compare({}, 8e-3, 1.2e-2);
  // A lamp that rays have to find makes noise.
  compare({.emission = Emission::kPatches, .rays = 2048}, 2e-2, 3e-2);
}

TEST(Radiosity, AllWaysAgreeWithTheOtherSolver) {
  const Patched room(made::colouredRoom(true));
  LightmapOptions other = plain(1024);
  other.method = LightmapMethod::kGather;
  other.cache_samples = 256;
  const auto truth = room.solve(other);
  for (const FormFactorsOf factors : {FormFactorsOf::kSampled, FormFactorsOf::kHemicube})
    for (const Solution solution : {Solution::kGathering, Solution::kProgressive}) {
      const auto e = room.solve(plain(256, {.form_factors = factors, .solution = solution}));
      EXPECT_LT(rms(e, truth), 0.02);
      // Near the edges of the room the view from the middle of a patch is not its mean view; and rays that
      // end at the foot of the block are answered by the part of the texel that they see in the other solver
      // alone.
      expectNear(room.mean(e), room.mean(truth), factors == FormFactorsOf::kSampled ? 6e-3 : 1.2e-2);
    }
}

TEST(Radiosity, ErrorsKnowTheSizeOfPatches) {
  // Little noise: what differs from the smallest patches is their size. The estimate is of its order.
  const Patched room(made::colouredRoom(true), 128);
  LightmapOptions options = plain(512, {.patch = 1, .rays = 64});
  options.part = Part::kIndirect;
  const auto truth = room.solve(options);
  double last = 0;
  for (const std::uint32_t patch : {4u, 8u}) {
    options.radiosity.patch = patch, options.radiosity.rays = 4096;
    const auto e = room.solve(options);
    double actual = 0, estimated = 0;
    for (std::size_t i = 0; i < e.value.size(); ++i) {
      if (e.back_share[i] > 0.25f) continue;
      const auto d = static_cast<double>(luminance(e.value[i].rgb - truth.value[i].rgb));
      actual += d * d, estimated += static_cast<double>(e.error[i]) * static_cast<double>(e.error[i]);
    }
    EXPECT_LT(std::sqrt(actual), 2 * std::sqrt(estimated));
    EXPECT_GT(std::sqrt(actual), 0.2 * std::sqrt(estimated));
    EXPECT_GT(estimated, last);
    last = estimated;
  }
}

TEST(Radiosity, BitsDependNeitherOnThreadsNorOnTheSelection) {
  scene::Scene scene = made::colouredRoom(true);
  scene.environment.radiance = Radiance(0.1f);
  const Patched room(std::move(scene), 32);
  for (const Solution solution : {Solution::kGathering, Solution::kProgressive}) {
    const LightmapOptions options = plain(16, {.solution = solution, .rays = 128});
    const auto all = room.solve(options);
    const std::vector<std::uint32_t> which = {5, 6, 100, 431};
    SilentProgress silent;
    const ThreadLimit limit(1);
    const auto one = room.solve(options);
    const auto some = LightmapSolver(room.tracer, room.atlas, room.texels, options).solve(silent, which);
    for (std::size_t i = 0; i < all.value.size(); ++i) {
      EXPECT_EQ(all.value[i], one.value[i]);
      EXPECT_EQ(all.error[i], one.error[i]);
    }
    for (std::size_t k = 0; k < which.size(); ++k) EXPECT_EQ(some.value[k], all.value[which[k]]);
  }
}

TEST(Radiosity, TexelsInsideGeometryDoNotDarkenTheRest) {
  // A block stands on a floor, sunk into it. Without the look-up's substitutes, and with texels inside the
  // block as parts of patches, the foot gets too little from the floor.
  scene::Scene scene;
  scene::Mesh ground, block;
  made::addQuad(ground, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
  made::addInstance(scene, std::move(ground));
  made::addBox(block, {-0.55f, -0.55f, -0.1f}, {0.55f, 0.55f, 1});
  made::addInstance(scene, std::move(block));
  scene.materials[0].base_colour = Vec4(0.8f, 0.8f, 0.8f, 1);
  scene.environment.radiance = Radiance(1.0f);
  const Patched lit(std::move(scene), 128);
  LightmapOptions options = plain(128);
  options.part = Part::kIndirect;
  options.method = LightmapMethod::kGather, options.cache_samples = 256;
  const auto truth = lit.solve(options);
  options.method = LightmapMethod::kRadiosity;
  for (const std::uint32_t patch : {1u, 8u}) {
    options.radiosity.patch = patch;
    const auto e = lit.solve(options);
    // The feet of the walls, over the floor.
    double sum = 0, expected = 0;
    for (std::size_t i = 0; i < e.value.size(); ++i) {
      const atlas::SurfacePoint& p = lit.texels.points[i];
      if (p.instance != 1 || std::abs(p.geometric_normal.z) > 0.1f || p.position.z < 0.01f ||
          p.position.z > 0.06f)
        continue;
      sum += static_cast<double>(e.value[i].rgb.x), expected += static_cast<double>(truth.value[i].rgb.x);
    }
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(sum, expected, 0.02 * expected) << patch;
  }
}

TEST(Radiosity, NormalMapsCostLight) {
  // Normals turned by 60 degrees get half of the direct light (reflectance.h): so does the first bounce.
  const auto room = [](bool mapped) {
    scene::Scene scene = made::box(Vec3(2), Vec3(1), Vec3(0));
    auto image = std::make_shared<image::Image8>(
        image::Image8{.width = 1, .height = 1, .channels = 4, .data = {238, 128, 191, 255}});
    scene.textures.push_back({.image = std::move(image)});
    for (scene::Mesh& m : scene.meshes) {
      m.uv[0].assign(m.positions.size(), Vec2(0));
      const Vec3 along = glm::normalize(m.positions[1] - m.positions[0]);
      m.tangents.assign(m.positions.size(), Vec4(along, 1));
    }
    for (scene::Material& m : scene.materials) {
      m.metallic = 1;
      if (mapped) m.normal_texture.texture = 0;
    }
    Light& light = scene.lights.emplace_back();
    light.position = Point(1), light.intensity = 10;
    return scene;
  };
  LightmapOptions options = plain(64, {.rays = 256});
  options.materials = Materials::kFull, options.part = Part::kIndirect, options.max_bounces = 1;
  const Patched plain_room(room(false), 32), mapped_room(room(true), 32);
  const double without = plain_room.mean(plain_room.solve(options)).x;
  EXPECT_NEAR(mapped_room.mean(mapped_room.solve(options)).x, 0.5 * without, 0.01 * without);
}

TEST(Radiosity, BacksOfSurfacesReflectNothing) {
  // The limit that the header states: a room of walls that face outwards has direct light alone.
  scene::Scene scene;
  scene::Mesh walls, plate;
  made::addBox(walls, {-2, -2, 0}, {2, 2, 3});
  made::addInstance(scene, std::move(walls));
  made::addQuad(plate, {-0.5f, -0.5f, 1}, {1, 0, 0}, {0, 1, 0});
  made::addInstance(scene, std::move(plate));
  Light& light = scene.lights.emplace_back();
  light.position = {0.3f, 0.2f, 2}, light.intensity = 10;
  const Patched room(std::move(scene), 32);
  LightmapOptions options = plain(64);
  const auto total = room.solve(options);
  EXPECT_GT(room.mean(total, 1).x, 5);
  options.part = Part::kIndirect;
  EXPECT_EQ(room.mean(room.solve(options), 1), glm::dvec3(0));
  // And the map says so: its texels look as if inside something.
  for (std::size_t i = 0; i < total.value.size(); ++i)
    EXPECT_TRUE(room.texels.points[i].instance != 1 || total.back_share[i] > 0.9f);
}

TEST(Radiosity, GlossyMaterialsKeepTheirEnergy) {
  // White metal loses nothing: with k bounces the mean over the walls is k + 1 times the direct one.
  scene::Scene scene = made::box(Vec3(2), Vec3(1), Vec3(0));
  for (scene::Material& m : scene.materials) m.metallic = 1, m.roughness = 0.3f;
  scene.materials[5].emission = Vec3(1);
  const Patched room(std::move(scene), 32);
  LightmapOptions options = plain(64, {.rays = 256});
  options.materials = Materials::kFull;
  options.max_bounces = 3;
  expectNear(room.mean(room.solve(options)), glm::dvec3(4 * M_PI / 6), 1e-2);
}

}  // namespace
}  // namespace relume::transport
