// SPDX-License-Identifier: MIT
// Pictures against closed forms.
#include "relume/picture/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "hand_made.h"
#include "relume/core/error.h"
#include "relume/core/parallel.h"

namespace relume::picture {
namespace {

template <class F>
ErrorCode codeOf(const F& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorCode::kUsage;
}

TEST(Obscurance, AConstantLayerGivesAlbedoTimesW) {
  const Vec3 albedo(0.25f, 0.5f, 1.0f);
  const scene::Scene scene = sceneOf({{.material = matte(albedo)}});
  const asset::Asset bake = constantBake(0.375f);
  const image::Image picture = rendered(scene, &bake, middle(), optionsOf(View::kObscurance, 5, 4));
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) expectNear(picture.rgb(x, y), 0.375f * albedo, 1e-6f);
}

// Texel i of a row holds (i + 1/2) / width: the interpolated value at u is u itself from the first texel's
// centre to the last one's, and constant beyond. The tent filter is symmetric, so a pixel has the value of
// its centre, up to the error of the mean of 256 Sobol points, below 1 % of a pixel.
TEST(Obscurance, ARampIsInterpolatedBetweenTexelCentres) {
  constexpr int kWidth = 8, kPixels = 16;
  asset::Asset bake = emptyBake(kWidth, 4);
  std::vector<float> ramp;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < kWidth; ++x) ramp.push_back((static_cast<float>(x) + 0.5f) / kWidth);
  addLayer(bake, "obscurance", "value", ramp);
  const scene::Scene scene = sceneOf({{}});
  const image::Image picture =
      rendered(scene, &bake, squareOn(1.0f), optionsOf(View::kObscurance, kPixels, 256));
  // Outside the kinks at u = 1/16 and 15/16, i.e. from pixel 2 to pixel 13.
  for (int x = 2; x <= 13; ++x) {
    const float u = (static_cast<float>(x) + 0.5f) / kPixels;
    for (int y = 1; y < kPixels - 1; ++y)
      EXPECT_NEAR(picture.rgb(x, y).r, u, 0.01f / kPixels) << x << ", " << y;
  }
  EXPECT_NEAR(picture.rgb(0, 8).r, 1.0f / 16, 0.02f);
}

TEST(Obscurance, AmbientIrradianceIsDividedByPi) {
  const scene::Scene scene = sceneOf({{}});
  const asset::Asset bake = constantBake(0.5f);
  PictureOptions options = optionsOf(View::kObscurance);
  options.ambient = Irradiance(Vec3(1, 2, 4));
  expectNear(onePixel(scene, &bake, middle(), options), 0.5f * kInvPi * Vec3(1, 2, 4), 1e-6f);
}

TEST(Obscurance, SpectralLayersColour) {
  asset::Asset bake = emptyBake(1, 1);
  addLayer(bake, "spectral", "value", {0.9f, 0.5f, 0.25f});
  const scene::Scene scene = sceneOf({{}});
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kObscurance)), {0.9f, 0.5f, 0.25f}, 1e-6f);
}

TEST(Obscurance, EmissionIsAdded) {
  scene::Material lamp = matte(Vec3(0.5f));
  lamp.emission = {3, 2, 1};
  const scene::Scene scene = sceneOf({{.material = lamp}});
  const asset::Asset bake = constantBake(0.5f);
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kObscurance)), Vec3(3.25f, 2.25f, 1.25f),
             1e-5f);
}

TEST(Obscurance, MetalsReflectTheAmbientLight) {
  scene::Material half_metal = matte(Vec3(0.5f, 0.25f, 1.0f));
  half_metal.metallic = 0.75f;
  const scene::Scene scene = sceneOf({{.material = half_metal}});
  const asset::Asset bake = constantBake(0.5f);
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kObscurance)), {0.25f, 0.125f, 0.5f}, 1e-6f);
}

TEST(Obscurance, UnlitMaterialsShowTheirColour) {
  scene::Material unlit = matte(Vec3(0.5f, 0.25f, 1.0f));
  unlit.unlit = true;
  const scene::Scene scene = sceneOf({{.material = unlit}});
  const asset::Asset bake = constantBake(0.1f);
  expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kObscurance)), {0.5f, 0.25f, 1.0f}, 1e-6f);
}

TEST(Obscurance, DynamicInstancesAreShownUnoccluded) {
  const scene::Scene scene =
      sceneOf({{.material = matte(Vec3(0.5f))},
               {.corner = {0, 0, 1}, .material = matte(Vec3(0.25f)), .dynamic = true}});
  const asset::Asset bake = constantBake(0.1f);
  PictureOptions options = optionsOf(View::kLit);
  options.lights.push_back({.intensity = 100.0f, .position = {0.5f, 0.5f, 2.0f}});
  for (const View view : {View::kObscurance, View::kLit}) {
    options.view = view;
    expectNear(onePixel(scene, &bake, middle(), options), Vec3(0.25f), 1e-6f);
  }
}

TEST(Occlusion, IsTheLayersValueOnWhite) {
  asset::Asset bake = constantBake(0.3f);
  addLayer(bake, "ao", "value", std::vector<float>(16, 0.7f));
  const scene::Scene scene = sceneOf({{.material = matte(Vec3(0.1f))}});
  PictureOptions options = optionsOf(View::kOcclusion);
  expectNear(onePixel(scene, &bake, middle(), options), Vec3(0.3f), 1e-6f);
  options.layer = "ao";
  expectNear(onePixel(scene, &bake, middle(), options), Vec3(0.7f), 1e-6f);
}

// The mean place of a pixel's samples is its centre, however few they are: a linear ramp comes out exact.
TEST(Filter, DoesNotShiftThePicture) {
  asset::Asset bake = emptyBake(2, 1);
  addLayer(bake, "obscurance", "value", {0.0f, 1.0f});
  const scene::Scene scene = sceneOf({{}});
  for (const int samples : {1, 2, 3, 7, 16}) {
    SCOPED_TRACE(testing::Message() << samples << " samples");
    expectNear(onePixel(scene, &bake, middle(), optionsOf(View::kOcclusion, 1, samples)), Vec3(0.5f), 1e-5f);
  }
}

// An edge a quarter of a pixel right of the pixel's centre leaves 1 - (3/4)^2 / 2 of a tent on its left.
TEST(Filter, IsATentOfOnePixelRadius) {
  const float edge = 1.0f + 0.5f + 0.25f;
  const scene::Scene scene =
      sceneOf({{.corner = {-10, -10, 0}, .edge_u = {10 + edge, 0, 0}, .edge_v = {0, 20, 0}}});
  const image::Image picture = rendered(scene, nullptr, squareOn(3.0f), optionsOf(View::kAlbedo, 3, 1024));
  EXPECT_NEAR(picture.rgb(1, 1).r, 1 - 0.75f * 0.75f / 2, 0.005f);
  EXPECT_NEAR(picture.rgb(0, 1).r, 1.0f, 1e-6f);
  EXPECT_NEAR(picture.rgb(2, 1).r, 0.25f * 0.25f / 2, 0.005f);
}

TEST(Camera, XIsRightAndYIsUp) {
  const scene::Scene scene =
      sceneOf({{.corner = {0.5f, 0.5f, 0}, .edge_u = {0.5f, 0, 0}, .edge_v = {0, 0.5f, 0}}});
  Viewpoint view = squareOn(1.0f);
  for (const bool orthographic : {true, false}) {
    if (!orthographic) view.ortho_height = 0, view.vertical_fov = 2 * std::atan(0.05f);
    const image::Image picture = rendered(scene, nullptr, view, optionsOf(View::kAlbedo, 8));
    EXPECT_EQ(picture.rgb(6, 1), Vec3(1.0f));
    EXPECT_EQ(picture.rgb(1, 1), Vec3(0.0f));
    EXPECT_EQ(picture.rgb(6, 6), Vec3(0.0f));
  }
}

TEST(Camera, AScaledNodeDoesNotScaleThePicture) {
  const scene::Scene scene = sceneOf({{.corner = {0.5f, 0, 0}}});
  Viewpoint view = squareOn(1.0f);
  const image::Image plain = rendered(scene, nullptr, view, optionsOf(View::kAlbedo, 8));
  for (int axis = 0; axis < 3; ++axis) view.world_from_camera[axis] *= 3.0f;
  EXPECT_EQ(rendered(scene, nullptr, view, optionsOf(View::kAlbedo, 8)).data, plain.data);
}

scene::Scene busyScene() {
  return sceneOf({{.corner = {-2, -2, 0}, .edge_u = {4, 0, 0}, .edge_v = {0, 4, 0}},
                  {.corner = {-0.5f, -0.5f, 0.5f}, .material = matte(Vec3(0.2f, 0.5f, 0.9f))},
                  {.corner = {0, 0, 1}, .material = translucent(Vec3(0.9f, 0.5f, 0.1f), 0.4f)}});
}

PictureOptions busyOptions() {
  PictureOptions options = optionsOf(View::kLit, 50, 8);
  options.width = 70;
  Light disk;
  disk.kind = Light::Kind::kArea;
  disk.position = {0, 0, 3};
  disk.direction = {0, 0, -1};
  disk.area = 1.0f;
  options.lights = {disk, {.intensity = 2.0f, .position = {1, 1, 2}}};
  return options;
}

TEST(Render, BitsDoNotDependOnThreads) {
  const scene::Scene scene = busyScene();
  const asset::Asset bake = constantBake(0.6f);
  const Viewpoint view = lookAt({2, -2, 3}, {0, 0, 0}, 0.8f);
  std::vector<image::Image> pictures;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    pictures.push_back(rendered(scene, &bake, view, busyOptions()));
  }
  EXPECT_EQ(
      std::memcmp(pictures[0].data.data(), pictures[1].data.data(), pictures[0].data.size() * sizeof(float)),
      0);
}

// A pixel's random numbers are its own: the upper left part of a picture does not depend on the rest of its
// rows.
TEST(Render, SizesThatAreNoMultipleOfABlockAreWhole) {
  const scene::Scene scene =
      sceneOf({{.corner = {-50, -50, 0}, .edge_u = {100, 0, 0}, .edge_v = {0, 100, 0}}});
  for (const int size : {1, 2, 3, 5, 33, 67}) {
    const image::Image picture = rendered(scene, nullptr, squareOn(1.0f), optionsOf(View::kAlbedo, size));
    ASSERT_EQ(picture.pixels(), static_cast<std::size_t>(size * size));
    for (const float value : picture.data) EXPECT_EQ(value, 1.0f);
  }
}

class CountingProgress : public Progress {
 public:
  void begin(std::string_view, std::uint64_t items) override { expected += items; }
  void advance(std::uint64_t items) override { done += items; }
  void end() override { ++ended; }
  std::uint64_t expected = 0;
  std::atomic<std::uint64_t> done{0};
  int ended = 0;
};

TEST(Render, ReportsProgressAndStopsWhenCancelled) {
  const scene::Scene scene = sceneOf({{}});
  const trace::Tracer tracer(scene);
  CountingProgress progress;
  const PictureOptions options = optionsOf(View::kAlbedo, 100);
  render(tracer, nullptr, squareOn(1.0f), options, progress);
  EXPECT_EQ(progress.expected, progress.done);
  EXPECT_EQ(progress.ended, 1);
  progress.cancel();
  EXPECT_EQ(codeOf([&] { render(tracer, nullptr, squareOn(1.0f), options, progress); }),
            ErrorCode::kInterrupted);
}

TEST(Render, RefusesWhatItCannotShow) {
  scene::Scene scene = sceneOf({{}});
  const asset::Asset bake = constantBake(1.0f);
  const auto code = [&](const asset::Asset* asset, const PictureOptions& options) {
    return codeOf([&] { rendered(scene, asset, squareOn(1.0f), options); });
  };
  EXPECT_EQ(code(nullptr, optionsOf(View::kObscurance)), ErrorCode::kNoSuchLayer);
  EXPECT_EQ(code(nullptr, optionsOf(View::kCharts)), ErrorCode::kNoSuchLayer);
  EXPECT_EQ(code(&bake, optionsOf(View::kBentNormal)), ErrorCode::kNoSuchLayer);
  PictureOptions named = optionsOf(View::kObscurance);
  named.layer = "spectral";
  EXPECT_EQ(code(&bake, named), ErrorCode::kNoSuchLayer);
  EXPECT_EQ(code(&bake, optionsOf(View::kObscurance, 0)), ErrorCode::kUsage);
  EXPECT_EQ(code(&bake, optionsOf(View::kObscurance, 1, 0)), ErrorCode::kUsage);
  asset::Asset short_plane = bake;
  short_plane.layers[0].planes[0].values.pop_back();
  EXPECT_EQ(code(&short_plane, optionsOf(View::kObscurance)), ErrorCode::kCorruptAsset);
  scene.meshes[0].atlas_page = 1;
  EXPECT_EQ(code(&bake, optionsOf(View::kObscurance)), ErrorCode::kMismatch);
  scene.meshes[0].atlas_page = 0;
  scene.meshes[0].uv[1].clear();
  EXPECT_EQ(code(&bake, optionsOf(View::kObscurance)), ErrorCode::kMismatch);
  scene.meshes[0].atlas_page = scene::kNone;
  EXPECT_EQ(code(&bake, optionsOf(View::kObscurance)), ErrorCode::kMismatch);
}

}  // namespace
}  // namespace relume::picture
