// SPDX-License-Identifier: MIT
// Light over kept rays against the closed forms of lightmap_test.cpp and against itself.
#include "relume/transport/light_sequence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lit_scene.h"
#include "made_rooms.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

using made::expectNear;
using made::Lit;

constexpr SequenceOptions kPlain{.gather_samples = 128, .materials = Materials::kLambert};

/// As a result of the solver of lightmaps, for the means over it.
LightmapResult asResult(std::vector<Vec3> irradiance) {
  LightmapResult result;
  for (const Vec3& e : irradiance) result.value.emplace_back(e);
  return result;
}

struct Sequence : Lit {
  explicit Sequence(scene::Scene the_scene, int page = 64, const SequenceOptions& options = kPlain)
      : Lit(std::move(the_scene), page), sequence(tracer, atlas, texels, options, silent) {}
  LightmapResult light() const {
    return asResult(sequence.light(sequence.direct(Emitters(scene)), scene.environment).irradiance);
  }
  mutable SilentProgress silent;
  LightSequence sequence;
};

TEST(LightSequence, AnIntegratingSphere) {
  // All bounces of a lamp together give 3.75 everywhere.
  scene::Scene scene = made::cavity(2, 0, Vec3(0.6f));
  Light& light = scene.lights.emplace_back();
  light.position = {0.5f, 0, 0.8f}, light.intensity = 10;
  const Sequence sphere(std::move(scene), 128);
  expectNear(sphere.mean(sphere.light()), glm::dvec3(3.75), 5e-3);
}

TEST(LightSequence, ACavityUnderASky) {
  scene::Scene scene = made::cavity(1, std::acos(0.4f), {0.8f, 0.5f, 0.2f});
  const Sequence cavity(std::move(scene), 128);
  const auto lit = cavity.sequence.light(cavity.sequence.dark(), {.radiance = Radiance(1.0f)});
  expectNear(cavity.mean(asResult(lit.irradiance)),
             {2.1419949910839495, 1.449965840118366, 1.095904414042951}, 5e-3);
  double error2 = 0, mean_error2 = 0;
  for (std::size_t i = 0; i < lit.irradiance.size(); ++i) {
    const double off = static_cast<double>(luminance(lit.irradiance[i])) - 1.5711;
    error2 += off * off, mean_error2 += static_cast<double>(lit.error[i] * lit.error[i]);
  }
  // All texels see the same: what they differ by is noise, and is known.
  EXPECT_LT(error2, 2 * mean_error2);
  EXPECT_GT(error2, mean_error2 / 8);
}

TEST(LightSequence, TheColouredRoomAgreesWithRadiosity) {
  const Sequence room(made::colouredRoom(false), 256);
  const auto indirect = room.light();
  for (const made::RoomCase& c : made::kColouredRoom)
    expectNear(room.about(indirect, c.p, c.n, 0.05f), c.total - c.direct, 1.5e-2, "indirect");
}

TEST(LightSequence, BacksReflectToo) {
  const Sequence in(made::roomOfWalls(false), 128), out(made::roomOfWalls(true), 128);
  const double expected = in.mean(in.light(), 1).x;
  EXPECT_GT(expected, 0.5);
  EXPECT_NEAR(out.mean(out.light(), 1).x, expected, 0.015 * expected);
}

TEST(LightSequence, IsLinearInLights) {
  scene::Scene scene = made::colouredRoom(true);
  const Sequence room(scene);
  const auto lamps = room.sequence.direct(Emitters(room.scene));
  auto twice = room.sequence.dark();
  twice.add(lamps, Vec3(0.5f)), twice.add(lamps, {1.5f, 0.5f, 1});
  const auto one = room.sequence.light(lamps, {}), other = room.sequence.light(twice, {});
  for (std::size_t i = 0; i < one.irradiance.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float gain = c == 0 ? 2.0f : c == 1 ? 1.0f : 1.5f;
      EXPECT_NEAR(other.irradiance[i][c], gain * one.irradiance[i][c], 2e-3f * one.irradiance[i][c] + 1e-6f);
    }
}

TEST(LightSequence, IsTheSameForAnyNumberOfThreads) {
  const auto solve = [](int threads) {
    const ThreadLimit limit(threads);
    const Sequence room(made::colouredRoom(true), 64, {.gather_samples = 64});
    return room.light();
  };
  const auto one = solve(1), two = solve(2);
  for (std::size_t i = 0; i < one.value.size(); ++i) EXPECT_EQ(one.value[i].rgb, two.value[i].rgb);
}

}  // namespace
}  // namespace relume::transport
