// SPDX-License-Identifier: MIT
// Lightmaps where light changes within a texel of what it is reflected by: behind the bar of a window, nearer
// to it than a texel is long. Truth: random walks for the same texels (LightmapMethod::kPath).
#include "lightmap/near_walk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lit_scene.h"
#include "made_scenes.h"

namespace relume::transport {
namespace {

using made::Lit;

/// A pane that shines along +z, a ledge beside it in its plane (instance 1), and over both a bar, 1 cm away.
scene::Scene window() {
  scene::Scene scene;
  scene::Mesh pane, ledge, bar;
  made::addMaterial(scene, Vec3(0.75f));
  made::addMaterial(scene, Vec3(0)).emission = Vec3(1);
  made::addQuad(pane, {0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0});
  made::addQuad(ledge, {0.5f, 0, 0}, {0.06f, 0, 0}, {0, 0.5f, 0});
  made::addBox(bar, {0.46f, 0, 0.01f}, {0.6f, 0.5f, 0.05f});
  made::addInstance(scene, std::move(pane), 1);
  made::addInstance(scene, std::move(ledge), 0);
  made::addInstance(scene, std::move(bar), 0);
  return scene;
}

double ledgeError(const Lit& lit, const LightmapResult& e, const LightmapResult& truth) {
  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < e.value.size(); ++i) {
    if (lit.texels.points[i].instance != 1) continue;
    const double own = luminance(e.value[i].rgb), right = luminance(truth.value[i].rgb);
    squares += std::pow(own - right, 2), sum += std::pow(right, 2);
  }
  return std::sqrt(squares / sum);
}

TEST(NearWalk, TheGapBehindABarIsAsBrightAsItIs) {
  const Lit lit(window(), 24);
  LightmapOptions options{.part = Part::kIndirect,
                          .materials = Materials::kLambert,
                          .min_samples = 1024,
                          .max_samples = 1024,
                          .cache_samples = 32};
  const LightmapResult e = lit.solve(options);
  options.method = LightmapMethod::kPath;
  options.min_samples = options.max_samples = 4096;
  const LightmapResult truth = lit.solve(options);
  double noise = 0, value = 0;
  int texels = 0;
  for (std::size_t i = 0; i < truth.value.size(); ++i)
    if (lit.texels.points[i].instance == 1)
      noise += std::pow(truth.error[i], 2), value += std::pow(luminance(truth.value[i].rgb), 2), ++texels;
  const double off = ledgeError(lit, e, truth);
  std::printf("%d texels, RMS %.2f %%, noise of the truth %.2f %%\n", texels, 100 * off,
              100 * std::sqrt(noise / value));
  ASSERT_GT(texels, 10);
  ASSERT_LT(std::sqrt(noise / value), 0.02) << "too noisy to prove anything";
  // Looked up in the cache, what the bar reflects made it 23 % wrong.
  EXPECT_LT(off, 0.05);
}

}  // namespace
}  // namespace relume::transport
