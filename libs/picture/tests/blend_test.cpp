// SPDX-License-Identifier: MIT
// Translucent and masked surfaces.
#include <gtest/gtest.h>

#include "hand_made.h"

namespace relume::picture {
namespace {

TEST(Blend, LayersAreCompositedInOrder) {
  const Vec3 front(1, 0, 0), between(0, 1, 0), back(0, 0, 1);
  // The file's order is not the order along the ray; the last one lies behind the solid surface.
  const scene::Scene scene = sceneOf({{.corner = {0, 0, 1}, .material = translucent(between, 0.5f)},
                                      {.material = matte(back)},
                                      {.corner = {0, 0, 2}, .material = translucent(front, 0.25f)},
                                      {.corner = {0, 0, -1}, .material = translucent(Vec3(9), 0.5f)}});
  const Vec3 expected = 0.25f * front + 0.75f * (0.5f * between + 0.5f * back);
  // Equal for each number of samples: nothing is left to chance.
  for (const int samples : {1, 3, 16})
    expectNear(onePixel(scene, nullptr, middle(), optionsOf(View::kAlbedo, 1, samples)), expected, 1e-6f);
}

// So dense that the tracer stops at it whatever the seed.
TEST(Blend, DenseLayersAreSeenThroughToo) {
  const scene::Scene scene = sceneOf({{}, {.corner = {0, 0, 1}, .material = translucent(Vec3(0.5f), 0.97f)}});
  expectNear(onePixel(scene, nullptr, middle(), optionsOf(View::kAlbedo, 1, 4)), Vec3(0.97f * 0.5f + 0.03f),
             1e-6f);
}

TEST(Blend, TheBackgroundShowsThrough) {
  const scene::Scene scene = sceneOf({{.material = translucent(Vec3(1, 0, 0), 0.25f)}});
  PictureOptions options = optionsOf(View::kAlbedo);
  options.background = {0, 0.5f, 0};
  expectNear(onePixel(scene, nullptr, middle(), options), {0.25f, 0.375f, 0}, 1e-6f);
}

TEST(Blend, OpaqueBlendIsSolid) {
  const scene::Scene scene = sceneOf({{}, {.corner = {0, 0, 1}, .material = translucent(Vec3(0.5f), 1.0f)}});
  expectNear(onePixel(scene, nullptr, middle(), optionsOf(View::kAlbedo)), Vec3(0.5f), 1e-6f);
}

TEST(Blend, MaskedSurfacesAreThereOrNot) {
  for (const float alpha : {0.3f, 0.7f}) {
    scene::Material mask = matte(Vec3(0.5f));
    mask.alpha_mode = scene::AlphaMode::kMask;
    mask.base_colour.a = alpha;
    const scene::Scene scene = sceneOf({{}, {.corner = {0, 0, 1}, .material = mask}});
    expectNear(onePixel(scene, nullptr, middle(), optionsOf(View::kAlbedo)), Vec3(alpha < 0.5f ? 1.0f : 0.5f),
               1e-6f);
  }
}

// A decal in the very plane of the floor: the floor may be missed with weight a^8 (1 - a) = 0.002.
TEST(Blend, ADecalDoesNotCutAHoleIntoItsFloor) {
  const scene::Scene scene = sceneOf({{}, {.material = translucent(Vec3(0, 0, 1), 0.5f)}});
  expectNear(onePixel(scene, nullptr, middle(), optionsOf(View::kAlbedo, 1, 256)), {0.5f, 0.5f, 1.0f}, 0.01f);
}

TEST(Blend, TranslucentSurfacesDimShadowRays) {
  const scene::Scene scene = sceneOf({{},
                                      {.corner = {0, 0, 1}, .material = translucent(Vec3(0.0f), 0.25f)},
                                      {.corner = {0, 0, 1.5f}, .material = translucent(Vec3(0.0f), 0.5f)}});
  const asset::Asset bake = constantBake(1.0f);
  PictureOptions options = optionsOf(View::kLit);
  options.ambient = Irradiance(0.0f);
  options.beta = 0.0f;
  options.lights.push_back({.intensity = 4 * kPi, .position = {0.5f, 0.5f, 2.0f}});
  Viewpoint view = lookAt({0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0}, 0.8f);
  view.ortho_height = 1e-4f;
  expectNear(onePixel(scene, &bake, view, options), Vec3(0.75f * 0.5f), 1e-4f);
}

}  // namespace
}  // namespace relume::picture
