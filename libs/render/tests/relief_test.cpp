// SPDX-License-Identifier: MIT
// Relief mapping where straight lines and the image library tell what is seen: a white square metre at y = 0
// with a height map over it, seen from above.
#include <cmath>

#include "gl_test.h"
#include "relume/image/relief.h"
#include "relume/render/renderer.h"

namespace relume::render {
namespace {

using Relief = GlTest;

constexpr int kMap = 64, kPicture = 64;
constexpr float kDepth = 0.1f;  // of the map's width: metres

std::shared_ptr<const image::Image8> grey(int width, int height, auto value) {
  auto im = std::make_shared<image::Image8>();
  im->width = width, im->height = height, im->channels = 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      im->data.push_back(static_cast<unsigned char>(std::lround(255 * value(x, y))));
  return im;
}

/// u along x, v along z.
scene::Scene squareWith(std::shared_ptr<const image::Image8> heights,
                        std::shared_ptr<const image::Image8> colours = {}) {
  scene::Scene scene;
  scene::Mesh mesh;
  mesh.positions = {{0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}};
  mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.flat_normals = true;
  scene.meshes.push_back(mesh);
  scene.instances.push_back({.mesh = 0});
  scene::Material material;
  material.metallic = 0;
  material.height_texture.texture = 0, material.height_scale = kDepth;
  scene.textures.push_back({.image = std::move(heights)});
  if (colours) {
    material.base_colour_texture.texture = 1;
    scene.textures.push_back({.image = std::move(colours)});
  }
  scene.materials.push_back(material);
  return scene;
}

/// Orthographic: the square fills the picture when seen from above. `slant`: tangent of the view's angle to
/// the vertical, towards +x.
FrameSettings fromAbove(View view, float slant = 0) {
  FrameSettings frame;
  frame.size = {kPicture, kPicture};
  frame.view = view;
  frame.full_materials = true;
  const Vec3 back = glm::normalize(Vec3(slant, 1, 0)), up(0, 0, -1), right = glm::cross(up, back);
  frame.camera.world_from_camera =
      Mat4(Vec4(right, 0), Vec4(up, 0), Vec4(back, 0), Vec4(Vec3(0.5f, 0, 0.5f) + 2.0f * back, 1));
  frame.camera.ortho_height = 1;
  return frame;
}

image::Image pictureOf(const scene::Scene& scene, const FrameSettings& frame) {
  Renderer renderer(scene, {.cube_size = 64, .plane_size = 64});
  renderer.draw(frame);
  return renderer.read();
}

float waves(int x, int y) {
  return 0.5f + 0.25f * std::sin(0.3f * static_cast<float>(x)) +
         0.25f * std::sin(0.2f * static_cast<float>(y));
}

TEST_F(Relief, DarkensIndirectLightAsTheImageLibrarySays) {
  const auto heights = grey(kMap, kMap, waves);
  image::Image shares(kMap, kMap, 1);
  for (std::size_t i = 0; i < shares.data.size(); ++i)
    shares.data[i] = static_cast<float>(heights->data[i]) / 255;
  const image::ReliefOptions how{.depth = kDepth};
  const image::Image open =
      image::reliefOcclusion(shares, image::reliefNormals(shares, how), image::reliefCones(shares, how));
  FrameSettings frame = fromAbove(View::kIndirect);
  frame.ambient = Irradiance(kPi);
  frame.size = {kMap, kMap};
  Renderer renderer(squareWith(heights), {.cube_size = 64, .plane_size = 64});
  renderer.draw(frame);
  const image::Image whole = renderer.read();
  frame.small_scale_gain = 0;
  renderer.draw(frame);
  const image::Image bare = renderer.read();
  float least = 1;
  for (int y = 1; y < kMap - 1; ++y)
    for (int x = 1; x < kMap - 1; ++x) {
      const float got = whole.rgb(x, y).x / bare.rgb(x, y).x;
      ASSERT_NEAR(got, *open.at(x, y), 2e-3f) << x << " " << y;
      least = std::min(least, got);
    }
  EXPECT_LT(least, 0.95f);
}

// A bottom that is flat lies kDepth below the square: what is painted on it moves by depth times slant.
TEST_F(Relief, MovesWhatIsBelowByDepthTimesSlant) {
  const auto bottom = grey(4, 4, [](int, int) { return 0.0f; });
  const auto halves = grey(256, 1, [](int x, int) { return x < 128 ? 0.0f : 1.0f; });
  const auto edge = [&](float slant, bool relief) {
    FrameSettings frame = fromAbove(View::kIndirect, slant);
    frame.ambient = Irradiance(kPi);
    frame.relief_steps = relief;
    frame.size = {256, 16};
    frame.camera.ortho_height = 1.0f / 16;
    const image::Image row = pictureOf(squareWith(bottom, halves), frame);
    int x = 128 - 60;
    while (row.rgb(x, 8).x < 0.5f) ++x;
    return (static_cast<float>(x) - 127.5f) / 256;  // from the middle, metres across the view
  };
  EXPECT_NEAR(edge(0, true), 0, 0.006f);
  for (const float slant : {0.5f, 1.0f}) {
    EXPECT_NEAR(edge(slant, false), 0, 0.006f);
    // A ray that enters at x comes from +x and meets the bottom at x - depth * slant.
    EXPECT_NEAR(edge(slant, true), kDepth * slant / std::hypot(1.0f, slant), 0.008f) << slant;
  }
}

TEST_F(Relief, ThrowsShadowsOnItself) {
  // The left half is high; a sun from the left at 45 degrees throws its edge's shadow as far as it is high.
  const auto step = grey(kMap, 1, [](int x, int) { return x < kMap / 2 ? 1.0f : 0.0f; });
  FrameSettings frame = fromAbove(View::kDirect);
  frame.lights = {
      {.kind = Light::Kind::kDirectional, .intensity = kPi, .direction = glm::normalize(Vec3(1, -1, 0))}};
  const scene::Scene scene = squareWith(step);
  const image::Image with = pictureOf(scene, frame);
  frame.relief_shadows = false;
  const image::Image without = pictureOf(scene, frame);
  const auto at = [](const image::Image& im, float x) {
    return im.rgb(static_cast<int>(x * kPicture), kPicture / 2).x;
  };
  for (const float x : {0.53f, 0.56f, 0.58f}) EXPECT_LT(at(with, x), 0.05f * at(without, x)) << x;
  for (const float x : {0.1f, 0.4f, 0.63f, 0.9f}) EXPECT_NEAR(at(with, x), at(without, x), 0.01f) << x;
  EXPECT_GT(at(without, 0.56f), 0.5f);
}

}  // namespace
}  // namespace relume::render
