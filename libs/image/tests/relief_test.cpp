// SPDX-License-Identifier: MIT
#include "relume/image/relief.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace relume::image {
namespace {

float radians(float degrees) { return degrees * kPi / 180; }

// Worked cases of the wedge: on top, at the bottom, between.
TEST(Relief, OcclusionIsThatOfTheWedge) {
  const auto w = [](float h, float alpha, float gamma) {
    return smallScaleOcclusion(std::cos(radians(alpha)), std::cos(radians(gamma)), h);
  };
  EXPECT_NEAR(w(1, 40, 60), 0.883022221559489, 1e-6);
  EXPECT_NEAR(w(0, 40, 60), 0.75, 1e-6);
  EXPECT_NEAR(w(0.35f, 25, 100), 0.6021682049896614, 1e-6);
}

Image randomHeights(int width, int height) {
  std::mt19937 random(4);
  Image h(width, height, 1);
  for (float& v : h.data) v = std::uniform_real_distribution<float>()(random);
  return h;
}

TEST(Relief, ConesAreThoseOfAllTexelsInTurn) {
  const Image h = randomHeights(13, 9);
  const float depth = 0.07f, texel = 1.0f / 13;
  const Image cones = reliefCones(h, {.depth = depth});
  int narrower = 0;
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 13; ++x) {
      float tangent = kWidestCone;
      for (int v = y - 18; v <= y + 18; ++v)
        for (int u = x - 26; u <= x + 26; ++u) {
          const float above = depth * (*h.at((u + 130) % 13, (v + 90) % 9) - *h.at(x, y));
          if (above > 0)
            tangent = std::min(
                tangent, texel * std::hypot(static_cast<float>(u - x), static_cast<float>(v - y)) / above);
        }
      const float expected = tangent >= kWidestCone ? 1.0f : std::sin(std::atan(tangent));
      EXPECT_NEAR(*cones.at(x, y), expected, 1e-5f) << x << " " << y;
      narrower += expected < 1;
    }
  EXPECT_GT(narrower, 50);
}

TEST(Relief, AFlatMapIsOpen) {
  const Image flat(8, 8, 1, 0.4f);
  const Image normals = reliefNormals(flat), cones = reliefCones(flat),
              open = reliefOcclusion(flat, normals, cones);
  EXPECT_EQ(normals.rgb(3, 3), Vec3(0, 0, 1));
  for (const float w : open.data) EXPECT_FLOAT_EQ(w, 1.0f);
}

// A ramp along u of slope s tilts its normals by atan s; along v downwards they lean to the top of the map.
TEST(Relief, NormalsAreThoseOfARamp) {
  Image across(16, 16, 1), down(16, 16, 1);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      *across.at(x, y) = static_cast<float>(x) / 16;
      *down.at(x, y) = static_cast<float>(y) / 16;
    }
  const float slope = 0.3f;  // height gained per width
  const Vec3 a = reliefNormals(across, {.depth = slope}).rgb(8, 8),
             d = reliefNormals(down, {.depth = slope}).rgb(8, 8);
  const Vec3 expected = glm::normalize(Vec3(-slope, 0, 1));
  EXPECT_NEAR(glm::length(a - expected), 0, 1e-5f);
  EXPECT_NEAR(glm::length(d - Vec3(0, -expected.x, expected.z)), 0, 1e-5f);
}

// At the bottom of a V of opening 2 delta the formula is the occlusion of a cone, sin^2 delta.
TEST(Relief, TheBottomOfAGrooveSeesItsOpening) {
  Image groove(32, 4, 1);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 32; ++x) *groove.at(x, y) = static_cast<float>(std::abs(x - 16)) / 16;
  const float depth = 0.5f;  // as deep as half its width: 45 degrees
  const Image open =
      reliefOcclusion(groove, reliefNormals(groove, {.depth = depth}), reliefCones(groove, {.depth = depth}));
  EXPECT_NEAR(*open.at(16, 1), 0.5f, 1e-5f);
  EXPECT_GT(*open.at(24, 1), *open.at(17, 1));
}

}  // namespace
}  // namespace relume::image
