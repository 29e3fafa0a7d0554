// SPDX-License-Identifier: MIT
// Lamps and their shadows ([IKSZ03] equation 5) against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "hand_made.h"

namespace relume::picture {
namespace {

// Equation 5 of [IKSZ03] by hand: I_A = 0.4, W = 0.55, beta = 0.2; a light of 10 cd at 2 m, cos 0.6, seen;
// one of 6 cd at 3 m, cos 0.9, hidden by a small card. I_S = 10/4 * 0.6 = 1.5, I'_S = 0.2 (10/4 + 6/9) =
// 0.63333.
TEST(Lit, IsEquationFive) {
  const float sin2 = std::sqrt(1.0f - 0.81f);
  const Point card = 0.5f * Point(-3 * sin2, 0, 2.7f);
  const scene::Scene scene =
      sceneOf({{.corner = {-5, -5, 0},
                .edge_u = {10, 0, 0},
                .edge_v = {0, 10, 0},
                .material = matte(Vec3(0.9f, 0.6f, 0.3f))},
               {.corner = card - Vec3(0.05f, 0.05f, 0), .edge_u = {0.1f, 0, 0}, .edge_v = {0, 0.1f, 0}}});
  const asset::Asset bake = constantBake(0.55f);
  PictureOptions options = optionsOf(View::kLit);
  options.ambient = Irradiance(0.4f);
  options.beta = 0.2f;
  options.lights.push_back({.intensity = 10.0f, .position = {1.6f, 0, 1.2f}});
  options.lights.push_back({.intensity = 6.0f, .position = 2.0f * card});
  Viewpoint view = lookAt({0, 0, 10}, {0, 0, 0}, 0.8f);
  view.ortho_height = 1e-3f;
  const float irradiance = (0.4f + 0.2f * (10.0f / 4 + 6.0f / 9)) * 0.55f + 1.5f;
  expectNear(onePixel(scene, &bake, view, options), Vec3(0.9f, 0.6f, 0.3f) * kInvPi * irradiance, 1e-3f);
}

TEST(Lit, MetalsReflectAsIfDiffusely) {
  scene::Material metal = matte(Vec3(0.5f, 0.25f, 1.0f));
  metal.metallic = 1.0f;
  const scene::Scene scene = sceneOf({{.material = metal}});
  const asset::Asset bake = constantBake(0.5f);
  PictureOptions options = optionsOf(View::kLit);
  options.beta = 0.0f;
  options.lights.push_back({.intensity = kPi, .position = {0.5f, 0.5f, 1.0f}});
  expectNear(onePixel(scene, &bake, middle(1e-3f), options), 1.5f * Vec3(0.5f, 0.25f, 1.0f), 1e-4f);
}

// A point light at height 2 over the middle of a card of half width 1/4 at height 1: the shadow on the floor
// has half width 1/2.
TEST(Lit, PointLightsCastSharpShadows) {
  const scene::Scene scene =
      sceneOf({{.corner = {-2, -2, 0}, .edge_u = {4, 0, 0}, .edge_v = {0, 4, 0}},
               {.corner = {-0.25f, -0.25f, 1}, .edge_u = {0.5f, 0, 0}, .edge_v = {0, 0.5f, 0}}});
  const asset::Asset bake = constantBake(1.0f);
  PictureOptions options = optionsOf(View::kLit, 64, 4);
  options.ambient = Irradiance(0.0f);
  options.beta = 0.0f;
  options.lights.push_back({.intensity = 4.0f * kPi, .position = {0, 0, 2}});
  // From below the card: the picture shows [-1, 1]^2 of the floor, whose pixels are 1/32 wide.
  Viewpoint view = lookAt({0, 0, 0.9f}, {0, 0, 0}, 0.8f);
  view.ortho_height = 2.0f;
  const image::Image picture = rendered(scene, &bake, view, options);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const Vec2 p = (Vec2(x, 63 - y) + 0.5f) / 32.0f - 1.0f;
      const float edge = std::max(std::abs(p.x), std::abs(p.y)) - 0.5f;
      const float value = picture.rgb(x, y).r;
      if (edge < -0.04f) {
        EXPECT_EQ(value, 0.0f) << x << ", " << y;
      }
      if (edge > 0.04f) {
        const float r2 = 4 + glm::dot(p, p);
        EXPECT_NEAR(value, 4 / r2 * 2 / std::sqrt(r2), 5e-3f) << x << ", " << y;
      }
    }
}

TEST(Lit, DirectionalLightsComeFromBehindTheirDirection) {
  const scene::Scene scene = sceneOf({{}});
  const asset::Asset bake = constantBake(1.0f);
  PictureOptions options = optionsOf(View::kLit);
  options.ambient = Irradiance(0.0f);
  options.beta = 0.0f;
  Light sun;
  sun.kind = Light::Kind::kDirectional;
  sun.intensity = kPi;
  sun.direction = {0.6f, 0, -0.8f};
  options.lights = {sun};
  expectNear(onePixel(scene, &bake, middle(), options), Vec3(0.8f), 1e-5f);
  options.lights[0].direction.z = 0.8f;
  expectNear(onePixel(scene, &bake, middle(), options), Vec3(0.0f), 0.0f);
}

// The side that is seen is lit, whichever way the triangle winds.
TEST(Lit, SurfacesAreTwoSided) {
  const scene::Scene scene = sceneOf({{.edge_u = {0, 1, 0}, .edge_v = {1, 0, 0}}});
  const asset::Asset bake = constantBake(1.0f);
  PictureOptions options = optionsOf(View::kLit);
  options.ambient = Irradiance(0.0f);
  options.beta = 0.0f;
  options.lights.push_back({.intensity = kPi, .position = {0.5f, 0.5f, 1.0f}});
  const Viewpoint view = middle(1e-3f);
  expectNear(onePixel(scene, &bake, view, options), Vec3(1.0f), 1e-4f);
  options.lights[0].position.z = -1.0f;
  expectNear(onePixel(scene, &bake, view, options), Vec3(0.0f), 0.0f);
}

// A disk of radius 1/2 at height 1 and a card at half its height that reaches to x = 1/8: from the point
// below the disk's centre the part x > 1/4 of the disk is seen, a segment of (acos(1/2) - sqrt(3)/4) / pi of
// its area.
TEST(Lit, AreaLightsCastSoftShadows) {
  const asset::Asset bake = constantBake(1.0f);
  PictureOptions options = optionsOf(View::kLit, 1, 64);
  options.ambient = Irradiance(0.0f);
  options.beta = 0.0f;
  Light disk;
  disk.kind = Light::Kind::kArea;
  disk.position = {0, 0, 1};
  disk.direction = {0, 0, -1};
  disk.area = kPi / 4;
  options.lights = {disk};
  Viewpoint view = lookAt({0, 0, 0.2f}, {0, 0, 0}, 0.8f);
  view.ortho_height = 1e-4f;
  const Quad floor{.corner = {-2, -2, 0}, .edge_u = {4, 0, 0}, .edge_v = {0, 4, 0}};
  const Quad card{.corner = {-2, -2, 0.5f}, .edge_u = {2.125f, 0, 0}, .edge_v = {0, 4, 0}};
  const float open = 0.25f / 1.25f;  // radiance 1 from R^2 / (R^2 + h^2) of the hemisphere
  const float seen = (std::acos(0.5f) - std::sqrt(3.0f) / 4) / kPi;
  expectNear(onePixel(sceneOf({floor}), &bake, view, options), Vec3(open), 1e-5f);
  expectNear(onePixel(sceneOf({floor, card}), &bake, view, options), Vec3(open * seen), 0.01f * open);
}

// A ball of 6 x 12 facets under a sun from the side: where its smooth normals see the sun, the facets must
// not hide it. Both pictures take the same sample of each pixel. Facets on the silhouette may be seen where
// their normals already turn away.
TEST(Lit, CoarseSmoothSurfacesHaveASmoothTerminator) {
  const scene::Scene scene = ball(6, 12);
  const asset::Asset bake = constantBake(1.0f);
  PictureOptions options = optionsOf(View::kLit, 64);
  options.ambient = Irradiance(0.0f);
  options.beta = 0.0f;
  Light sun;
  sun.kind = Light::Kind::kDirectional;
  sun.intensity = kPi;
  sun.direction = glm::normalize(Vec3(-1, -0.3f, -0.2f));
  options.lights = {sun};
  Viewpoint view = lookAt({0, 0, 5}, {0, 0, 0}, 0.8f);
  view.ortho_height = 2.0f;
  const image::Image lit = rendered(scene, &bake, view, options);
  options.view = View::kNormal;
  const image::Image normals = rendered(scene, &bake, view, options);
  int seen = 0, hidden = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      if (normals.rgb(x, y) == Vec3(0.0f)) continue;  // background
      const float cosine = glm::dot(2.0f * normals.rgb(x, y) - 1.0f, -sun.direction);
      if (cosine > 0.02f) {
        ++seen;
        hidden += std::abs(lit.rgb(x, y).r - cosine) > 1e-3f ? 1 : 0;
      } else if (cosine < 0) {
        EXPECT_EQ(lit.rgb(x, y).r, 0.0f) << x << ", " << y;
      }
    }
  EXPECT_GT(seen, 1000);
  EXPECT_EQ(hidden, 0) << "of " << seen;
}

}  // namespace
}  // namespace relume::picture
