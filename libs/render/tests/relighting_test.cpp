// SPDX-License-Identifier: MIT
// Relighting on the device against the run-time library, where nothing throws shadows: entries, exits and
// texels under every kind of light, and after lights have changed.
#include <cmath>

#include "gl_test.h"
#include "made_bake.h"
#include "made_lights.h"
#include "relume/relight/transfer_relighter.h"
#include "relume/render/renderer.h"

namespace relume::render {
namespace {

using RelightingTest = GlTest;

void expectSame(std::span<const Irradiance> got, std::span<const Irradiance> expected, const char* what) {
  ASSERT_EQ(got.size(), expected.size()) << what;
  double error = 0, norm = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    error += std::pow(glm::length(got[i].rgb - expected[i].rgb), 2);
    norm += std::pow(glm::length(expected[i].rgb), 2);
  }
  ASSERT_GT(norm, 0) << what;
  // The run-time rounds coefficients to 16 bits of the largest.
  EXPECT_LT(std::sqrt(error / norm), 2e-4) << what;
}

void expectRunTimes(Renderer& renderer, relight::TransferRelighter& relighter, const LightSet& lights,
                    const char* what) {
  SCOPED_TRACE(what);
  FrameSettings frame;
  frame.size = {8, 8};
  frame.lights = lights;
  renderer.draw(frame);
  const auto entries = relighter.entryIrradiance(lights);
  expectSame(renderer.readEntries(), entries, "entries");
  relighter.relight(entries);
  expectSame(renderer.readTexels(), relighter.texels(), "texels");
}

TEST_F(RelightingTest, IsThatOfTheRunTime) {
  for (const bool short_ways : {false, true}) {
    SCOPED_TRACE(short_ways ? "means, without short ways" : "modes, whole");
    asset::Asset bake = relight::madeBake({.columns = 90}, 4, 5, short_ways ? 1 : 3);
    if (short_ways) {
      asset::Transfer transfer = asset::readTransfer(bake.layers[0], bake.atlas);
      for (std::size_t i = 0; i < bake.atlas.texel.size(); ++i)
        transfer.near_share.push_back(Vec3(i % 3, i % 5, 0) * (51.0f / 255));
      bake.layers[0].tables = asset::transferTables(transfer, bake.atlas);
    }
    relight::TransferRelighter relighter(bake, bake.layers[0]);
    const scene::Scene nothing;
    Renderer renderer(nothing, {.cube_size = 64, .plane_size = 64});
    renderer.setTransfer(bake, bake.layers[0]);
    LightSet lights = relight::someLights(5);
    expectRunTimes(renderer, relighter, lights, "first");
    lights[2].colour = {1, 0, 3};
    expectRunTimes(renderer, relighter, lights, "another colour");
    lights[0].position.x += 1;
    expectRunTimes(renderer, relighter, lights, "moved");
    lights = relight::someLights(23);
    expectRunTimes(renderer, relighter, lights, "more lights");
    lights.resize(2);
    expectRunTimes(renderer, relighter, lights, "fewer lights");
    expectRunTimes(renderer, relighter, lights, "the same");
  }
}

TEST_F(RelightingTest, RefusesWhatIsNoTransfer) {
  asset::Asset bake = relight::madeBake({.columns = 10});
  bake.layers[0].tables.clear();
  Renderer renderer(scene::Scene{}, {.cube_size = 64, .plane_size = 64});
  EXPECT_THROW(renderer.setTransfer(bake, bake.layers[0]), Error);
}

}  // namespace
}  // namespace relume::render
