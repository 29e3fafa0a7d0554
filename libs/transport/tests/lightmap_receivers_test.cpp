// SPDX-License-Identifier: MIT
// Directional bases filled by the lightmap solver: against its own irradiance, and against the reference for
// normals that a normal map turns.
#include <gtest/gtest.h>

#include "lit_scene.h"
#include "made_rooms.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

using made::Lit;
using made::plain;

LightmapOptions withReceiver(const std::string& name, std::uint32_t samples) {
  LightmapOptions options = plain(samples);
  options.receiver = basis::makeBasis(name);
  return options;
}

/// What the basis makes of a texel's sums for a normal.
Vec3 irradianceAt(const Lit& room, const LightmapResult& result, const basis::Basis& basis, std::size_t i,
                  Normal n) {
  const basis::Receiver at(room.texels.points[i].shading_normal);
  std::vector<float> c(basis.coefficients());
  basis.finish(at, std::span(result.sums).subspan(i * basis.sums(), basis.sums()), c);
  return basis.irradiance(at, c, n).rgb;
}

/// Where each arrival goes to one sum, they make up the irradiance, lamps and gather rays alike.
TEST(LightmapReceivers, SumsAreTheIrradiance) {
  const Lit room(made::colouredRoom(false), 64);
  for (const char* name : {"irradiance", "directions:14"}) {
    const LightmapOptions options = withReceiver(name, 64);
    const LightmapResult result = room.solve(options);
    const std::size_t sums = options.receiver->sums();
    ASSERT_EQ(result.sums.size(), result.value.size() * sums);
    for (std::size_t i = 0; i < result.value.size(); ++i) {
      Vec3 sum(0.0f);
      for (std::size_t k = 0; k < sums; k += 3)
        sum += Vec3(result.sums[i * sums + k], result.sums[i * sums + k + 1], result.sums[i * sums + k + 2]);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(sum[c], result.value[i].rgb[c], 1e-4f * (0.01f + sum[c])) << i;
    }
  }
}

/// RMS over texels and turned normals, relative to the mean: what the bases leave of the truth, noise of 1 %
/// included. A basis that ignores the normal is off by far more.
TEST(LightmapReceivers, TurnedNormalsAgreeWithTheReference) {
  const Lit room(made::colouredRoom(false), 64);
  const Reference reference(room.scene);
  SilentProgress silent;
  const auto error = [&](const std::string& name) {
    const LightmapOptions options = withReceiver(name, 256);
    std::vector<std::uint32_t> which;
    for (std::uint32_t i = 7; i < room.texels.points.size(); i += 97)
      if (room.texels.points[i].coverage > 0.99f) which.push_back(i);
    const LightmapResult all = room.solve(options);
    std::vector<Receiver> receivers;
    std::vector<Vec3> baked;
    for (const std::uint32_t i : which) {
      const atlas::SurfacePoint& p = room.texels.points[i];
      const Frame frame = Frame::about(p.shading_normal);
      for (const Vec3 tilt : {Vec3(0.5f, 0, 1), Vec3(-0.3f, 0.4f, 1), Vec3(0, -0.6f, 1)}) {
        const Normal n = glm::normalize(frame.toWorld(tilt));
        receivers.push_back({p.position, p.geometric_normal, n});
        baked.push_back(irradianceAt(room, all, *options.receiver, i, n));
      }
    }
    ReferenceOptions how;
    how.samples = 1024, how.materials = Materials::kLambert;
    const auto truth = reference.irradiance(receivers, how, silent);
    double squares = 0, mean = 0;
    for (std::size_t i = 0; i < baked.size(); ++i) {
      const Vec3 d = baked[i] - truth.value[i].rgb;
      squares += static_cast<double>(glm::dot(d, d)) / 3;
      mean += static_cast<double>(luminance(truth.value[i].rgb));
    }
    const auto n = static_cast<double>(baked.size());
    return std::sqrt(squares / n) / (mean / n);
  };
  const double ignored = error("irradiance");
  testing::Test::RecordProperty("irradiance", std::to_string(ignored));
  EXPECT_GT(ignored, 0.15);
  for (const auto& [name, allowed] :
       {std::pair{"sh3", 0.08}, {"directions:64", 0.05}, {"sg9", 0.07}, {"sg5", 0.1}, {"hbasis6", 0.08}}) {
    const double found = error(name);
    testing::Test::RecordProperty(name, std::to_string(found));
    EXPECT_LT(found, allowed) << name;
  }
}

TEST(LightmapReceivers, BitsDoNotDependOnThreads) {
  const Lit room(made::colouredRoom(false), 32);
  const LightmapOptions options = withReceiver("sg5", 32);
  const auto many = room.solve(options);
  const ThreadLimit one(1);
  EXPECT_EQ(room.solve(options).sums, many.sums);
}

}  // namespace
}  // namespace relume::transport
