// SPDX-License-Identifier: MIT
// Direct light and shadows on a floor under a card, where both are known in closed form.
#include "gl_test.h"

#include <cmath>

#include "relume/image/image.h"
#include "relume/render/renderer.h"

namespace relume::render {
namespace {

using ShadowMapsTest = GlTest;

constexpr int kSize = 128;
constexpr float kFloor = 4.0f;  // metres that the picture spans

void addQuad(scene::Scene& scene, Point corner, Vec3 u, Vec3 v) {
  scene::Mesh mesh;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.flat_normals = true;
  scene.instances.push_back({.mesh = static_cast<std::uint32_t>(scene.meshes.size())});
  scene.meshes.push_back(mesh);
}

/// A white floor, and a card of 1 x 1 m over its middle at a height of 1 m.
scene::Scene cardOverFloor() {
  scene::Scene scene;
  scene.materials.push_back({.metallic = 0.0f});
  addQuad(scene, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  addQuad(scene, {-0.5f, 1, 0.5f}, {1, 0, 0}, {0, 0, -1});
  return scene;
}

/// The floor seen from below the card's height: straight down through a camera whose near side begins there.
image::Image floorFromBelow(const LightSet& lights) {
  scene::Scene scene = cardOverFloor();
  Renderer renderer(scene, {.cube_size = 512, .plane_size = 1024});
  FrameSettings frame;
  frame.size = {kSize, kSize};
  frame.view = View::kDirect;
  frame.lights = lights;
  // From below the floor: it is lit on the side from which it is seen, so lights stand below, too.
  frame.camera.world_from_camera =
      Mat4(Vec4(1, 0, 0, 0), Vec4(0, 0, 1, 0), Vec4(0, -1, 0, 0), Vec4(0, -3, 0, 1));
  frame.camera.ortho_height = kFloor;
  renderer.draw(frame);
  return renderer.read();
}

/// The same from above, with the card in the picture's middle hidden by nobody: only what is outside is used.
image::Image floorFromAbove(const LightSet& lights) {
  Renderer renderer(cardOverFloor(), {.cube_size = 512, .plane_size = 1024});
  FrameSettings frame;
  frame.size = {kSize, kSize};
  frame.view = View::kDirect;
  frame.lights = lights;
  frame.camera.world_from_camera =
      Mat4(Vec4(1, 0, 0, 0), Vec4(0, 0, -1, 0), Vec4(0, 1, 0, 0), Vec4(0, 5, 0, 1));
  frame.camera.ortho_height = kFloor;
  renderer.draw(frame);
  return renderer.read();
}

/// Pixel centres: x to the right, z downwards, the picture's middle at the origin.
float placeOf(int pixel) { return (static_cast<float>(pixel) + 0.5f) * kFloor / kSize - 0.5f * kFloor; }

// What a pixel beside the edge is must be right; at the edge it may be anything between.
void expectLitButFor(const image::Image& picture, const Light& light, Box3 shadow, Box3 unseen) {
  constexpr float kEdge = 0.06f;  // metres: two pixels, or four texels of the maps
  int dark = 0, bright = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Point p(placeOf(x), 0, placeOf(y));
      if (unseen.distance(p) < kEdge) continue;
      const float lit = directIrradiance(light, p, {0, 1, 0}).rgb.x * kInvPi;
      const bool inside = p.x > shadow.lo.x + kEdge && p.x < shadow.hi.x - kEdge &&
                          p.z > shadow.lo.z + kEdge && p.z < shadow.hi.z - kEdge;
      const float got = picture.rgb(x, y).x;
      if (inside) {
        ASSERT_LT(got, 0.02f * lit) << p.x << " " << p.z;
        ++dark;
      } else if (shadow.distance(p) > kEdge) {
        ASSERT_NEAR(got, lit, 0.005f * lit) << p.x << " " << p.z;
        ++bright;
      }
    }
  EXPECT_GT(dark, 200);
  EXPECT_GT(bright, 2000);
}

const Box3 kCard{{-0.5f, 0, -0.5f}, {0.5f, 0, 0.5f}};

TEST_F(ShadowMapsTest, OfAPointLightLieWhereStraightLinesPutThem) {
  // From (1.5, 2, 0) the card's edges are thrown to 2 x - 1.5 and 2 z.
  const Light lamp{.kind = Light::Kind::kPoint, .intensity = 30, .position = {1.5f, 2, 0}};
  expectLitButFor(floorFromAbove({lamp}), lamp, {{-2.5f, 0, -1}, {-0.5f, 0, 1}}, kCard);
}

TEST_F(ShadowMapsTest, OfADirectionalLightAreMovedCopies) {
  const Light sun{
      .kind = Light::Kind::kDirectional, .intensity = 5, .direction = glm::normalize(Vec3(-1, -1, 0.5f))};
  expectLitButFor(floorFromAbove({sun}), sun, {{-1.5f, 0, 0}, {-0.5f, 0, 1}}, kCard);
}

TEST_F(ShadowMapsTest, OfASpotLightAndAnAreaLightAreThoseOfTheirMiddle) {
  Light spot{.kind = Light::Kind::kSpot, .intensity = 30, .position = {1.5f, 2, 0}, .direction = {0, -1, 0}};
  spot.inner_cone = 1.2f, spot.outer_cone = 1.4f;
  expectLitButFor(floorFromAbove({spot}), spot, {{-2.5f, 0, -1}, {-0.5f, 0, 1}}, kCard);
  const Light area{.kind = Light::Kind::kArea,
                   .intensity = 30,
                   .position = {1.5f, 2, 0},
                   .direction = {0, -1, 0},
                   .area = 1e-4f};
  expectLitButFor(floorFromAbove({area}), area, {{-2.5f, 0, -1}, {-0.5f, 0, 1}}, kCard);
}

TEST_F(ShadowMapsTest, FlatSurfacesThrowNoneOnThemselvesFromEitherSide) {
  const Light below{.kind = Light::Kind::kPoint, .intensity = 30, .position = {1.0f, -0.4f, 0.3f}};
  const image::Image picture = floorFromBelow({below});
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Point p(placeOf(x), 0, -placeOf(y));
      const float lit = directIrradiance(below, p, {0, -1, 0}).rgb.x * kInvPi;
      ASSERT_NEAR(picture.rgb(x, y).x, lit, 0.01f * lit + 1e-4f) << p.x << " " << p.z;
    }
}

TEST_F(ShadowMapsTest, FollowWhatMovesAndLightsThatCome) {
  Renderer renderer(cardOverFloor(), {.cube_size = 256, .plane_size = 256});
  FrameSettings frame;
  frame.size = {kSize, kSize};
  frame.view = View::kDirect;
  frame.lights = {{.kind = Light::Kind::kPoint, .intensity = 30, .position = {1.5f, 2, 0}}};
  frame.camera.world_from_camera =
      Mat4(Vec4(1, 0, 0, 0), Vec4(0, 0, -1, 0), Vec4(0, 1, 0, 0), Vec4(0, 5, 0, 1));
  frame.camera.ortho_height = kFloor;
  const auto at = [&](float x, float z) {
    renderer.draw(frame);
    return renderer.read()
        .rgb(static_cast<int>((x / kFloor + 0.5f) * kSize), static_cast<int>((z / kFloor + 0.5f) * kSize))
        .x;
  };
  const float lit = directIrradiance(frame.lights[0], {-1.5f, 0, 0}, {0, 1, 0}).rgb.x * kInvPi;
  EXPECT_LT(at(-1.5f, 0), 0.02f * lit);
  renderer.place(1, Mat4(Vec4(1, 0, 0, 0), Vec4(0, 1, 0, 0), Vec4(0, 0, 1, 0), Vec4(0, 0, 2.5f, 1)));
  EXPECT_NEAR(at(-1.5f, 0), lit, 0.02f * lit);
  renderer.place(1, Mat4(1));
  EXPECT_LT(at(-1.5f, 0), 0.02f * lit);
  frame.lights[0].position.x = -1.5f;  // now straight above
  EXPECT_GT(at(-1.5f, 0), 1.5f);
  frame.lights.push_back({.kind = Light::Kind::kDirectional, .intensity = 5, .direction = {0, -1, 0}});
  EXPECT_NEAR(at(1.5f, 0),
              (directIrradiance(frame.lights[0], {1.5f, 0, 0}, {0, 1, 0}).rgb.x * 0 + 5) * kInvPi, 0.05f);
}

}  // namespace
}  // namespace relume::render
