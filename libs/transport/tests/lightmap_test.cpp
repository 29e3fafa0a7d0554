// SPDX-License-Identifier: MIT
// Lightmaps against closed forms, against the reference, and against themselves. Expected values: see
// reference_test.cpp, which has the same scenes. Means over surfaces are compared where a form is the same
// all over; elsewhere the texels about a point, whose mean is the point's value to second order.
#include "relume/transport/lightmap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lit_scene.h"
#include "made_rooms.h"
#include "relume/core/parallel.h"
#include "relume/scene/light_groups.h"

namespace relume::transport {
namespace {

using made::expectNear;
using made::Lit;
using made::plain;

TEST(Lightmap, AFurnaceAndItsBounces) {
  // Exitance 2, reflectance 0.75: after k bounces 8 (1 - 0.75^(k + 1)) everywhere; every ray and every light
  // sample finds the same, so there is hardly any noise. The MIS weights of direct light are what remains.
  const Lit furnace(made::box({4, 3, 2.5f}, Vec3(0.75f), Vec3(2 / kPi)));
  for (const int bounces : {0, 1, 2, 7, ReferenceOptions::kUnlimited}) {
    LightmapOptions options = plain(64);
    options.max_bounces = bounces;
    const double exact = bounces < 0 ? 8 : 8 * (1 - std::pow(0.75, bounces + 1));
    expectNear(furnace.mean(furnace.solve(options)), glm::dvec3(exact), 4e-3);
    if (bounces == 0) {
      options.part = Part::kIndirect;
      EXPECT_EQ(furnace.mean(furnace.solve(options)), glm::dvec3(0));
    }
  }
}

TEST(Lightmap, AnIntegratingSphere) {
  // All bounces together 3.75 everywhere, the first 1.5.
  scene::Scene scene = made::cavity(2, 0, Vec3(0.6f));
  Light& light = scene.lights.emplace_back();
  light.position = {0.5f, 0, 0.8f}, light.intensity = 10;
  const Lit sphere(std::move(scene), 128);
  LightmapOptions options = plain(64);
  options.part = Part::kIndirect;
  expectNear(sphere.mean(sphere.solve(options)), glm::dvec3(3.75), 5e-3);
  options.max_bounces = 1;
  expectNear(sphere.mean(sphere.solve(options)), glm::dvec3(1.5), 5e-3);
  // Direct light has no other texel in it: I cos / r^2 at the texels about a point.
  options.part = Part::kDirect;
  expectNear(sphere.about(sphere.solve(options), {2, 0, 0}, {-1, 0, 0}, 0.15f),
             glm::dvec3(3.0531243639324246), 1e-2);
}

TEST(Lightmap, ACavityUnderASky) {
  scene::Scene scene = made::cavity(1, std::acos(0.4f), {0.8f, 0.5f, 0.2f});
  scene.environment.radiance = Radiance(1.0f);
  const Lit cavity(std::move(scene), 128);
  expectNear(cavity.mean(cavity.solve(plain(64))), {2.1419949910839495, 1.449965840118366, 1.095904414042951},
             5e-3);
}

TEST(Lightmap, TheColouredRoomAgreesWithRadiosity) {
  const Lit room(made::colouredRoom(false), 256);
  LightmapOptions options = plain(128);
  options.cache_samples = 64;
  const auto total = room.solve(options);
  options.part = Part::kDirect;
  const auto direct = room.solve(options);
  options.part = Part::kIndirect;
  const auto indirect = room.solve(options);
  for (const made::RoomCase& c : made::kColouredRoom) {
    expectNear(room.about(total, c.p, c.n, 0.05f), c.total, 8e-3, "total");
    expectNear(room.about(direct, c.p, c.n, 0.05f), c.direct, 8e-3, "direct");
    expectNear(room.about(indirect, c.p, c.n, 0.05f), c.total - c.direct, 1.2e-2, "indirect");
  }
}

TEST(Lightmap, TheRoomWithABlockAgreesWithAnotherPathTracer) {
  const Lit room(made::colouredRoom(true), 256);
  LightmapOptions options = plain(128);
  options.cache_samples = 64;
  const auto e = room.solve(options);
  expectNear(room.about(e, {1.3f, 0.9f, 0}, {0, 0, 1}, 0.05f), {1.63762720, 1.17615725, 0.32760439}, 1.2e-2);
  expectNear(room.about(e, {0.2f, 1.3f, 0}, {0, 0, 1}, 0.05f), {0.49434045, 0.11661503, 0.03026759}, 2e-2);
  expectNear(room.about(e, {0.6f, 2, 0.6f}, {0, -1, 0}, 0.05f), {0.74623925, 0.43226462, 0.11147470}, 1.2e-2);
  expectNear(room.about(e, {0.65f, 1.3f, 1.2f}, {0, 0, 1}, 0.05f), {4.44208196, 2.95670403, 0.95071046},
             1.2e-2);
}

TEST(Lightmap, BacksOfSurfacesReflectToo) {
  LightmapOptions options = plain(256);
  options.part = Part::kIndirect;
  const Lit in(made::roomOfWalls(false), 128), out(made::roomOfWalls(true), 128);
  const double expected = in.mean(in.solve(options), 1).x;
  EXPECT_GT(expected, 0.5);
  EXPECT_NEAR(out.mean(out.solve(options), 1).x, expected, 0.015 * expected);
}

TEST(Lightmap, TexelsInsideGeometryAreFoundAndDoNotDarkenTheRest) {
  // A block stands on a floor, sunk into it: the floor inside is dark and sees backs. Without the look-up's
  // substitutes the block's foot gets too little from the floor.
  scene::Scene scene;
  scene::Mesh ground, block;
  made::addQuad(ground, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
  made::addInstance(scene, std::move(ground));
  made::addBox(block, {-0.5f, -0.5f, -0.1f}, {0.5f, 0.5f, 1});
  made::addInstance(scene, std::move(block));
  scene.materials[0].base_colour = Vec4(0.8f, 0.8f, 0.8f, 1);
  scene.environment.radiance = Radiance(1.0f);
  const Lit lit(std::move(scene), 128);
  const auto e = lit.solve(plain(256));
  for (std::size_t i = 0; i < lit.texels.points.size(); ++i) {
    const atlas::SurfacePoint& p = lit.texels.points[i];
    if (p.instance != 0) continue;
    const float inside = std::max(std::abs(p.position.x), std::abs(p.position.y));
    if (inside < 0.45f) {
      EXPECT_GT(e.back_share[i], 0.9f);
    } else if (inside > 0.55f) {
      EXPECT_EQ(e.back_share[i], 0.0f);
    }
  }
}

TEST(Lightmap, ErrorsAreWhatTheySay) {
  const Lit room(made::colouredRoom(true), 64);
  LightmapOptions options = plain(2048);
  options.cache_samples = 256;
  const auto truth = room.solve(options);
  options = plain(64);
  options.cache_samples = 256;
  double actual = 0, estimated = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    options.seed = 100 + seed;
    const auto e = room.solve(options);
    for (std::size_t i = 0; i < e.value.size(); ++i) {
      if (e.back_share[i] > 0.25f) continue;
      const double d = luminance(e.value[i].rgb - truth.value[i].rgb);
      actual += d * d, estimated += static_cast<double>(e.error[i]) * e.error[i];
    }
  }
  EXPECT_LT(actual, 1.3 * estimated);
  EXPECT_GT(actual, 0.3 * estimated);
}

TEST(Lightmap, StoppingEarlyReachesItsErrorAndLeavesNoBias) {
  scene::Scene scene = made::colouredRoom(true);
  const Lit room(std::move(scene), 64);
  LightmapOptions options = plain(4096);
  options.cache_samples = 256;
  const auto truth = room.solve(options);
  options.min_samples = 16, options.target_error = 0.05f;
  const auto e = room.solve(options);
  EXPECT_LT(e.rays, truth.rays / 8);
  const double mean = luminance(Vec3(room.mean(truth)));
  EXPECT_NEAR(luminance(Vec3(room.mean(e))), mean, 4e-3 * mean);
  double squares = 0;
  for (std::size_t i = 0; i < e.value.size(); ++i)
    squares += std::pow(luminance(e.value[i].rgb - truth.value[i].rgb), 2);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(e.value.size())), 0.05 * mean);
}

TEST(Lightmap, BitsDependNeitherOnThreadsNorOnTheSelection) {
  scene::Scene scene = made::colouredRoom(true);
  scene.environment.radiance = Radiance(0.1f);
  const Lit room(std::move(scene), 64);
  LightmapOptions options{.min_samples = 16, .max_samples = 64, .target_error = 0.02f, .smoothed = true};
  const auto all = room.solve(options);
  LightmapResult one;
  {
    const ThreadLimit limit(1);
    one = room.solve(options);
  }
  const std::vector<std::uint32_t> which = {5, 6, 100, 731};
  const auto some = room.solve(options, which);
  for (std::size_t i = 0; i < all.value.size(); ++i) EXPECT_EQ(all.value[i], one.value[i]);
  for (std::size_t k = 0; k < which.size(); ++k) {
    EXPECT_EQ(some.value[k], all.value[which[k]]);
    EXPECT_EQ(some.error[k], all.error[which[k]]);
  }
}

// Light is a sum over what shines: lamps, emissive surfaces and the environment, each alone.
TEST(Lightmap, GroupsOfLightsSumToAllLight) {
  scene::Scene scene = made::colouredRoom(true);
  scene.instances.erase(scene.instances.begin());  // a wall less: the environment comes in
  scene.environment.radiance = Radiance(0.1f);
  scene::Material& wall = scene.materials[scene.meshes[scene.instances[0].mesh].material];
  wall.name = "sign", wall.emission = Vec3(0, 2, 0);
  const Point middle = scene.bounds().centre();
  for (const char* group : {"left", "right", "left"}) {
    Light& lamp = scene.lights.emplace_back();
    lamp.group = group, lamp.colour = group[0] == 'l' ? Vec3(1, 0.5f, 0) : Vec3(0.2f, 0.6f, 1);
    lamp.position = middle + Vec3(0.1f * static_cast<float>(scene.lights.size()), 0, 0);
  }
  const std::vector<std::string> groups = scene::lightGroups(scene);
  ASSERT_TRUE(std::find(groups.begin(), groups.end(), "left") <
              std::find(groups.begin(), groups.end(), "sign"));
  const Lit lit(scene);
  LightmapOptions options = plain(256);
  const LightmapResult whole = lit.solve(options);
  std::vector<glm::dvec3> sum(whole.value.size(), glm::dvec3(0));
  for (const std::string& group : groups) {
    options.group = group;
    const LightmapResult part = lit.solve(options);
    EXPECT_GT(glm::length(lit.mean(part)), 0) << group;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += glm::dvec3(part.value[i].rgb);
  }
  LightmapResult together = whole;
  for (std::size_t i = 0; i < sum.size(); ++i) together.value[i] = Irradiance(Vec3(sum[i]));
  // The choice among the lamps is the same in all blocks of texels, so their noise does not average out.
  expectNear(lit.mean(together), lit.mean(whole), 0.02);
}

TEST(Lightmap, GlossyMaterialsKeepTheirEnergy) {
  // White metal loses nothing: with k bounces the mean over the walls is k + 1 times the direct one.
  scene::Scene scene = made::box(Vec3(2), Vec3(1), Vec3(0));
  for (scene::Material& m : scene.materials) m.metallic = 1, m.roughness = 0.3f;
  scene.materials[5].emission = Vec3(1);
  const Lit room(std::move(scene));
  LightmapOptions options = plain(64);
  options.materials = Materials::kFull;
  options.max_bounces = 3;
  expectNear(room.mean(room.solve(options)), glm::dvec3(4 * M_PI / 6), 1e-2);
}

TEST(Lightmap, GlossySurfacesSendLightWhereTheyMirrorIt) {
  // Brushed metal throws the lamp's light down from a wall, and from the floor back to the ceiling. As from
  // diffuse surfaces of the same energy, means of faces would be up to a fifth off.
  scene::Scene scene = made::colouredRoom(false);
  for (const auto& [face, roughness] : {std::pair{4, 0.5f}, std::pair{0, 0.5f}}) {
    scene::Material& m = scene.materials[static_cast<std::size_t>(face)];
    m.base_colour = Vec4(0.9f, 0.8f, 0.7f, 1), m.metallic = 1, m.roughness = roughness;
  }
  const Lit room(std::move(scene));
  LightmapOptions options{
      .part = Part::kIndirect, .min_samples = 256, .max_samples = 256, .cache_samples = 64};
  const auto fast = room.solve(options);
  options.method = LightmapMethod::kPath;
  const auto truth = room.solve(options);
  for (std::uint32_t face = 0; face < 9; ++face) {
    const glm::dvec3 expected = room.mean(truth, face);
    double squares = 0, count = 0;
    for (std::size_t i = 0; i < truth.error.size(); ++i)
      if (room.texels.points[i].instance == face) squares += std::pow(truth.error[i], 2), ++count;
    // Four standard errors of the truth, and what the cache's few texels and rays may cost.
    const double noise = 4 * std::sqrt(squares) / count / static_cast<double>(luminance(Vec3(expected)));
    expectNear(room.mean(fast, face), expected, 0.005 + noise, std::to_string(face).c_str());
  }
}

}  // namespace
}  // namespace relume::transport
