// SPDX-License-Identifier: MIT
// Lights against closed forms of KHR_lights_punctual and of a disk.
#include "relume/core/light.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relume {
namespace {

TEST(LightTest, PointFollowsTheInverseSquareAndTheCosine) {
  const Light lamp{
      .kind = Light::Kind::kPoint, .colour = {1, 0.5f, 0}, .intensity = 10, .position = {0, 2, 0}};
  const Irradiance facing = incidentIrradiance(lamp, {0, 0, 0});
  EXPECT_FLOAT_EQ(facing.rgb.x, 2.5f);
  EXPECT_FLOAT_EQ(facing.rgb.y, 1.25f);
  const Normal tilted = glm::normalize(Vec3(1, 1, 0));
  EXPECT_NEAR(directIrradiance(lamp, {0, 0, 0}, tilted).rgb.x, 2.5 * std::sqrt(0.5), 1e-6);
  EXPECT_EQ(directIrradiance(lamp, {0, 0, 0}, {0, -1, 0}).rgb.x, 0);
}

TEST(LightTest, RangeWindowReachesZero) {
  Light lamp{.kind = Light::Kind::kPoint, .intensity = 16, .range = 4, .position = {0, 0, 0}};
  EXPECT_NEAR(incidentIrradiance(lamp, {2, 0, 0}).rgb.x, 16.0 / 4 * (1 - 1.0 / 16), 1e-5);  // 1 - (2/4)^4
  EXPECT_EQ(incidentIrradiance(lamp, {4, 0, 0}).rgb.x, 0);
  EXPECT_EQ(incidentIrradiance(lamp, {5, 0, 0}).rgb.x, 0);
}

TEST(LightTest, SpotConeIsTheSquareOfALinearRampInTheCosine) {
  const Light spot{.kind = Light::Kind::kSpot,
                   .intensity = 1,
                   .inner_cone = 0.2f,
                   .outer_cone = 0.6f,
                   .position = {0, 1, 0},
                   .direction = {0, -1, 0}};
  EXPECT_NEAR(incidentIrradiance(spot, {0, 0, 0}).rgb.x, 1, 1e-6);
  const double angle = 0.4, x = std::tan(angle), r2 = 1 + x * x;
  const double ramp = (std::cos(angle) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
  EXPECT_NEAR(incidentIrradiance(spot, {static_cast<float>(x), 0, 0}).rgb.x, ramp * ramp / r2, 1e-5);
  EXPECT_EQ(incidentIrradiance(spot, {1, 0, 0}).rgb.x, 0);  // 45 degrees is outside
}

// E of a disk of radius R on its axis at distance h: pi L R^2 / (R^2 + h^2).
TEST(LightTest, AreaLightIsExactOnTheAxisOfADisk) {
  const float radius = 0.7f, height = 0.5f;
  const Light disk{.kind = Light::Kind::kArea,
                   .intensity = 3,
                   .position = {0, height, 0},
                   .direction = {0, -1, 0},
                   .area = kPi * radius * radius};
  EXPECT_NEAR(directIrradiance(disk, {0, 0, 0}, {0, 1, 0}).rgb.x,
              kPi * 3 * radius * radius / (radius * radius + height * height), 1e-5);
  EXPECT_EQ(directIrradiance(disk, {0, 1, 0}, {0, -1, 0}).rgb.x, 0);  // behind it
}

TEST(LightTest, DirectionalIsLuxEverywhere) {
  const Light sun{.kind = Light::Kind::kDirectional, .intensity = 3, .direction = {0, -1, 0}};
  EXPECT_EQ(incidentIrradiance(sun, {1e6f, 0, 0}).rgb.x, 3);
  EXPECT_NEAR(directIrradiance(sun, {0, 0, 0}, glm::normalize(Vec3(std::sqrt(3.0f), 1, 0))).rgb.x, 1.5, 1e-6);
}

}  // namespace
}  // namespace relume
