// SPDX-License-Identifier: MIT
// Lights against closed forms of KHR_lights_punctual and of a disk.
#include "relume/core/light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relume/core/sampling.h"

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

TEST(LightTest, AreaLightsMayShineToBothSides) {
  Light disk{.kind = Light::Kind::kArea, .direction = {0, -1, 0}, .area = 1};
  const float below = incidentIrradiance(disk, {0.3f, -1, 0}).rgb.x;
  EXPECT_EQ(incidentIrradiance(disk, {0.3f, 1, 0}).rgb.x, 0);
  disk.two_sided = true;
  EXPECT_GT(below, 0);
  EXPECT_EQ(incidentIrradiance(disk, {0.3f, -1, 0}).rgb.x, below);
  EXPECT_EQ(incidentIrradiance(disk, {0.3f, 1, 0}).rgb.x, below);
}

// Two triangles of different size: first and second moments are those of the areas.
TEST(LightTest, PlacesOnAPolygonAreEvenlySpread) {
  Light light{.kind = Light::Kind::kArea};
  light.triangles = {{Point(0, 0, 0), Point(2, 0, 0), Point(0, 1, 0)},
                     {Point(2, 0, 0), Point(3, 2, 0), Point(0, 1, 0)}};
  // Of each triangle: area, sum of corners / 3, and the second moment of x, area / 6 (sum of products).
  double area = 0, x = 0, xx = 0, y = 0;
  for (const auto& [a, b, c] : light.triangles) {
    const double own = 0.5 * static_cast<double>(glm::length(glm::cross(b - a, c - a)));
    area += own, x += own * (a.x + b.x + c.x) / 3.0, y += own * (a.y + b.y + c.y) / 3.0;
    xx += own / 6.0 * (a.x * a.x + b.x * b.x + c.x * c.x + a.x * b.x + b.x * c.x + c.x * a.x);
  }
  constexpr std::uint32_t kPlaces = 1u << 14;
  double mean_x = 0, mean_y = 0, mean_xx = 0;
  for (std::uint32_t i = 0; i < kPlaces; ++i) {
    const Point p = pointOn(light, sobol2(i, 7));
    EXPECT_EQ(p.z, 0);
    mean_x += p.x / kPlaces, mean_y += p.y / kPlaces, mean_xx += static_cast<double>(p.x) * p.x / kPlaces;
  }
  EXPECT_NEAR(mean_x, x / area, 1e-3);
  EXPECT_NEAR(mean_y, y / area, 1e-3);
  EXPECT_NEAR(mean_xx, xx / area, 2e-3);
}

TEST(LightTest, PlacesOnADiskAndOnAPoint) {
  Light disk{.kind = Light::Kind::kArea, .position = {1, 2, 3}, .direction = {0, -1, 0}, .area = kPi};
  double square = 0;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const Vec3 off = pointOn(disk, sobol2(i, 7)) - disk.position;
    EXPECT_EQ(off.y, 0);
    EXPECT_LE(glm::length(off), 1.0001f);
    square += static_cast<double>(glm::dot(off, off)) / 4096;
  }
  EXPECT_NEAR(square, 0.5, 1e-3);
  disk.kind = Light::Kind::kPoint;
  EXPECT_EQ(pointOn(disk, {0.3f, 0.4f}), disk.position);
}

TEST(LightTest, DirectionalIsLuxEverywhere) {
  const Light sun{.kind = Light::Kind::kDirectional, .intensity = 3, .direction = {0, -1, 0}};
  EXPECT_EQ(incidentIrradiance(sun, {1e6f, 0, 0}).rgb.x, 3);
  EXPECT_NEAR(directIrradiance(sun, {0, 0, 0}, glm::normalize(Vec3(std::sqrt(3.0f), 1, 0))).rgb.x, 1.5, 1e-6);
}

}  // namespace
}  // namespace relume
