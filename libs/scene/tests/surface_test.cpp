// SPDX-License-Identifier: MIT
// Surface attributes at hits, on scenes made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "relume/scene/scene.h"

namespace relume::scene {
namespace {

void expectNear(Vec3 a, Vec3 b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

/// One triangle (0,0,0), (1,0,0), (0,1,0) facing +z, with the texture coordinates (0,0), (1,0), (0,1).
Scene triangle(const Mat4& place = Mat4(1)) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.uv[0] = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  scene.materials.emplace_back().metallic = 0;
  scene.instances.emplace_back().world_from_local = place;
  return scene;
}

Texture checker(bool srgb) {
  image::Image8 im{2, 2, 4, {255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 51, 255, 255, 255, 255}};
  Texture t;
  t.image = std::make_shared<const image::Image8>(std::move(im));
  t.srgb = srgb;
  return t;
}

TEST(Surface, PositionsAndCoordinatesInterpolate) {
  const Scene scene = triangle(glm::translate(Mat4(1), Vec3(5, 0, 0)));
  expectNear(worldPosition(scene, {0, 0, 0.25f, 0.5f}), {5.25f, 0.5f, 0});
  EXPECT_EQ(textureCoordinate(scene, {0, 0, 0.25f, 0.5f}, 0), Vec2(0.25f, 0.5f));
  EXPECT_EQ(textureCoordinate(scene, {0, 0, 0.25f, 0.5f}, 1), Vec2(0));
  EXPECT_EQ(textureCoordinate(scene, {0, 0, 0.25f, 0.5f}, 77), Vec2(0));
}

TEST(Surface, NormalsFollowTheTransform) {
  expectNear(geometricNormal(triangle(), 0, 0), {0, 0, 1});
  expectNear(geometricNormal(triangle(glm::rotate(Mat4(1), kPi / 2, Vec3(1, 0, 0))), 0, 0), {0, -1, 0});
  // A sheared plane: the normal is not the transformed normal.
  Mat4 shear(1);
  shear[0][2] = 1;  // z += x
  const Scene sheared = triangle(shear);
  expectNear(geometricNormal(sheared, 0, 0), glm::normalize(Vec3(-1, 0, 1)));
  expectNear(shadingNormal(sheared, {0, 0, 0.3f, 0.3f}), glm::normalize(Vec3(-1, 0, 1)));
}

TEST(Surface, AMirrorKeepsTheOutsideOutside) {
  for (const Vec3 scale : {Vec3(-1, 1, 1), Vec3(1, -2, 1), Vec3(-1, -1, -1), Vec3(1e-6f), Vec3(1e6f)}) {
    const Scene scene = triangle(glm::scale(Mat4(1), scale));
    const Normal outside(0, 0, scale.z > 0 ? 1 : -1);
    expectNear(geometricNormal(scene, 0, 0), outside);
    expectNear(shadingNormal(scene, {0, 0, 0.3f, 0.3f}), outside);
  }
}

TEST(Surface, ShadingNormalIsOnTheGeometricSide) {
  Scene scene = triangle();
  scene.meshes[0].normals = {{0.6f, 0, 0.8f}, {0, 0, -1}, {0, 0, 0}};
  expectNear(shadingNormal(scene, {0, 0, 0, 0}), {0.6f, 0, 0.8f});
  expectNear(shadingNormal(scene, {0, 0, 1, 0}), {0, 0, 1});
  expectNear(shadingNormal(scene, {0, 0, 0, 1}), {0, 0, 1});  // none to be had
  scene.meshes[0].flat_normals = true;
  expectNear(shadingNormal(scene, {0, 0, 0, 0}), {0, 0, 1});
}

TEST(Surface, DegenerateTrianglesHaveNoGeometricNormal) {
  EXPECT_EQ(geometricNormal(triangle(glm::scale(Mat4(1), Vec3(0, 1, 1))), 0, 0), Normal(0));
  Scene scene = triangle();
  scene.meshes[0].positions[2] = {2, 0, 0};
  EXPECT_EQ(geometricNormal(scene, 0, 0), Normal(0));
  expectNear(shadingNormal(scene, {0, 0, 0.3f, 0.3f}), {0, 0, 1});
}

TEST(Surface, CombinesFactorTextureAndVertexColour) {
  Scene scene = triangle();
  Material& m = scene.materials[0];
  m.base_colour = {0.5f, 0.5f, 0.5f, 1};
  m.metallic = 0.25f;
  m.emission = {2, 4, 8};
  scene.textures = {checker(false)};
  m.base_colour_texture.texture = m.emission_texture.texture = 0;
  scene.meshes[0].colours = {Vec4(1, 1, 1, 0.5f), Vec4(1, 1, 1, 0.5f), Vec4(1, 1, 1, 0.5f)};
  const Hit blue{0, 0, 0.25f, 0.75f};  // uv at the centre of texel (0, 1): (0, 0, 1, 0.2)
  const Surface s = surfaceAt(scene, blue);
  EXPECT_EQ(s.base_colour, Vec4(0, 0, 0.5f, 0.1f));
  EXPECT_EQ(s.emission.rgb, Vec3(0, 0, 8));
  expectNear(s.albedo().rgb, {0, 0, 0.375f});
  EXPECT_EQ(opacityAt(scene, blue), 1.0f);
  m.alpha_mode = AlphaMode::kBlend;
  EXPECT_FLOAT_EQ(opacityAt(scene, blue), 0.1f);
  m.alpha_mode = AlphaMode::kMask;
  m.alpha_cutoff = 0.09f;
  EXPECT_EQ(opacityAt(scene, blue), 1.0f);
  m.alpha_cutoff = 0.11f;
  EXPECT_EQ(opacityAt(scene, blue), 0.0f);
}

TEST(Surface, UnlitNeitherReflectsNorEmits) {
  Scene scene = triangle();
  scene.materials[0].unlit = true;
  scene.materials[0].emission = Vec3(3);
  const Surface s = surfaceAt(scene, {0, 0, 0, 0});
  EXPECT_EQ(s.base_colour, Vec4(1));
  EXPECT_EQ(s.albedo().rgb, Vec3(0));
  EXPECT_EQ(s.emission.rgb, Vec3(0));
}

TEST(Texture, BilinearAndWrapped) {
  Texture t = checker(false);
  EXPECT_EQ(t.sample({0.25f, 0.25f}), Vec4(1, 0, 0, 1));  // row 0 is at v = 0
  EXPECT_EQ(t.sample({0.25f, 0.75f}), Vec4(0, 0, 1, 0.2f));
  EXPECT_EQ(t.sample({0.5f, 0.25f}), Vec4(0.5f, 0.5f, 0, 0.5f));
  EXPECT_EQ(t.sample({1.25f, -2.75f}), Vec4(1, 0, 0, 1));
  EXPECT_EQ(t.sample({0.0f, 0.25f}), Vec4(0.5f, 0.5f, 0, 0.5f));  // the last texel is beside the first
  t.wrap_u = t.wrap_v = Wrap::kClamp;
  EXPECT_EQ(t.sample({0.0f, 0.0f}), Vec4(1, 0, 0, 1));
  EXPECT_EQ(t.sample({-7.0f, 9.0f}), Vec4(0, 0, 1, 0.2f));
  t.wrap_u = t.wrap_v = Wrap::kMirror;
  EXPECT_EQ(t.sample({0.0f, 0.0f}), Vec4(1, 0, 0, 1));
  EXPECT_EQ(t.sample({1.25f, 0.25f}), Vec4(0, 1, 0, 0));
  EXPECT_EQ(t.sample({-0.25f, 2.25f}), Vec4(1, 0, 0, 1));
  EXPECT_EQ(t.sample({2.0f, 2.0f}), Vec4(1, 0, 0, 1));
}

TEST(Texture, EveryCoordinateIsSafe) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror}) {
    Texture t = checker(true);
    t.wrap_u = t.wrap_v = wrap;
    for (const float u :
         {kNan, kInfinity, -kInfinity, 1e38f, -1e38f, -1e-38f, 0.99999994f, -0.0f, 16777216.0f, 1.9999999f})
      for (const float v : {kNan, 1e38f, -1e-38f, 0.5f}) {
        const Vec4 c = t.sample({u, v});
        for (int k = 0; k < 4; ++k) EXPECT_TRUE(c[k] >= 0 && c[k] <= 1) << u << " " << v;
      }
  }
}

TEST(Texture, OneToFourChannels) {
  const auto sample = [](int channels, std::vector<unsigned char> data, bool srgb) {
    Texture t;
    t.image = std::make_shared<const image::Image8>(image::Image8{1, 1, channels, std::move(data)});
    t.srgb = srgb;
    return t.sample({0.5f, 0.5f});
  };
  EXPECT_EQ(sample(1, {51}, false), Vec4(0.2f, 0.2f, 0.2f, 1));
  EXPECT_EQ(sample(2, {255, 51}, true), Vec4(1, 1, 1, 0.2f));  // alpha is never sRGB
  EXPECT_EQ(sample(3, {255, 0, 51}, false), Vec4(1, 0, 0.2f, 1));
  EXPECT_EQ(Texture().sample({0, 0}), Vec4(1));
}

// KHR_texture_transform: offset, then rotation, then scale as matrices from the left. By a quarter turn u
// goes where -v was: counter-clockwise as seen with v downwards, as in three.js and Babylon.js.
TEST(TextureRef, Transforms) {
  TextureRef ref;
  EXPECT_EQ(ref.apply({0.3f, 0.7f}), Vec2(0.3f, 0.7f));
  ref.scale = {2, 3};
  ref.offset = {10, 20};
  EXPECT_EQ(ref.apply({1, 1}), Vec2(12, 23));
  ref.rotation = kPi / 2;
  EXPECT_NEAR(ref.apply({1, 0}).x, 10, 1e-5f);
  EXPECT_NEAR(ref.apply({1, 0}).y, 18, 1e-5f);
  EXPECT_NEAR(ref.apply({0, 1}).x, 13, 1e-5f);
  EXPECT_NEAR(ref.apply({0, 1}).y, 20, 1e-5f);
}

TEST(Scene, BoundsAndCountAreOfStaticInstances) {
  Scene scene = triangle();
  scene.instances.push_back(scene.instances[0]);
  scene.instances[1].world_from_local = glm::translate(Mat4(1), Vec3(100));
  EXPECT_EQ(scene.triangleCount(), 2u);
  EXPECT_EQ(scene.bounds().hi, Point(101, 101, 100));
  scene.instances[1].dynamic = true;
  EXPECT_EQ(scene.triangleCount(), 1u);
  EXPECT_EQ(scene.bounds().lo, Point(0));
  EXPECT_EQ(scene.bounds().hi, Point(1, 1, 0));
}

/// A map of one colour: the normal (x, y, z) in tangent space.
Scene withNormalMap(Vec3 local, const Mat4& place = Mat4(1)) {
  Scene scene = triangle(place);
  Texture t;
  const auto code = [](float x) { return static_cast<unsigned char>(std::lround(255 * (0.5f * x + 0.5f))); };
  t.image = std::make_shared<const image::Image8>(
      image::Image8{1, 1, 3, {code(local.x), code(local.y), code(local.z)}});
  scene.textures.push_back(t);
  scene.materials[0].normal_texture.texture = 0;
  return scene;
}

TEST(Surface, NormalMapsBendAlongTheirTexture) {
  // u runs along +x. v runs along +y in `triangle`, so the top of the map, where green points, is -y.
  const Vec3 right = glm::normalize(Vec3(0.6f, 0, 0.8f)), up = glm::normalize(Vec3(0, 0.6f, 0.8f));
  const Hit hit{0, 0, 0.3f, 0.3f};
  expectNear(mappedNormal(withNormalMap(right), hit), {0.6f, 0, 0.8f}, 0.01f);
  expectNear(mappedNormal(withNormalMap(up), hit), {0, -0.6f, 0.8f}, 0.01f);
  // A mirror image has the mirrored normals.
  const Mat4 mirror = glm::scale(Mat4(1), Vec3(-1, 1, 1));
  expectNear(mappedNormal(withNormalMap(right, mirror), hit), {-0.6f, 0, 0.8f}, 0.01f);
  expectNear(mappedNormal(withNormalMap(up, mirror), hit), {0, -0.6f, 0.8f}, 0.01f);
  // With tangents of the file the same, and the scale of the map counts.
  Scene told = withNormalMap(up);
  told.meshes[0].tangents.assign(3, Vec4(1, 0, 0, -1));
  expectNear(mappedNormal(told, hit), {0, -0.6f, 0.8f}, 0.01f);
  told.materials[0].normal_scale = 0;
  expectNear(mappedNormal(told, hit), {0, 0, 1}, 0.01f);
}

TEST(Environment, MapAndWorldAgree) {
  for (const Vec2 uv : {Vec2(0.1f, 0.2f), Vec2(0.5f, 0.5f), Vec2(0.9f, 0.7f)}) {
    const Vec2 back = equirectFromDirection(directionFromEquirect(uv));
    EXPECT_LT(glm::length(back - uv), 1e-5f);
  }
  expectNear(directionFromEquirect({0.5f, 0.5f}), {1, 0, 0});
  expectNear(directionFromEquirect({0.25f, 0.5f}), {0, 0, -1});
  // 8 x 4 pixels, one bright one above +x; turned by a quarter to the left it is above -z.
  auto map = std::make_shared<image::Image>(8, 4, 3);
  map->setRgb(4, 1, Vec3(8));
  Environment environment{Radiance(0.5f), map, 0};
  const Direction d = directionFromEquirect({4.5f / 8, 1.5f / 4});
  EXPECT_NEAR(environment.from(d).rgb.r, 4, 1e-4f);
  environment.rotation = kPi / 2;
  EXPECT_NEAR(environment.from({d.z, d.y, -d.x}).rgb.r, 4, 1e-4f);
  EXPECT_EQ((Environment{Radiance(2.0f), nullptr, 0}).from({0, 1, 0}), Radiance(2.0f));
}

}  // namespace
}  // namespace relume::scene
