// SPDX-License-Identifier: MIT
#include "relume/scene/day_sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relume/core/daylight.h"
#include "relume/core/sampling.h"

namespace relume::scene {
namespace {

/// Lux on a horizontal plane, by cosine-weighted directions.
double horizontal(const Environment& sky) {
  constexpr std::uint32_t kSamples = 1 << 14;
  double sum = 0;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const Direction d = squareToCosineHemisphere(sobol2(i, 1));
    sum += static_cast<double>(luminance(sky.from({d.x, d.z, -d.y}).rgb));
  }
  return sum * M_PI / kSamples;
}

TEST(DaySky, GivesTheIlluminanceOfTheClearSky) {
  Day day;
  day.scale = 0.5f;
  for (const double hour : {2.0, 3.0, 6.0, 11.4, 19.0, 20.5}) {
    const double expected = 0.5 * skyIlluminance(day.sunAt(hour * 60).elevation_deg);
    EXPECT_NEAR(horizontal(skyAt(day, hour * 60)), expected, 0.02 * expected) << hour;
  }
}

TEST(DaySky, IsBrightestNearTheSunAndEvenAtNight) {
  const Day day;
  const double morning = 5 * 60;
  const Environment sky = skyAt(day, morning);
  Direction beside = day.toSun(morning), opposite(-beside.x, beside.y, -beside.z);
  EXPECT_GT(luminance(sky.from(beside).rgb), 2 * luminance(sky.from(opposite).rgb));
  Day winter = day;
  winter.date = {2011, 12, 21};
  EXPECT_TRUE(skyAt(winter, 0).dark());
  winter.sky = Day::Sky::kNone;
  EXPECT_TRUE(skyAt(winter, 720).dark());
}

// A share of 0.15 of what falls on it from the sky and the sun, from all its directions alike.
TEST(DaySky, HasGroundBelowTheHorizon) {
  const Day day;
  const double noon = 11.4 * 60;
  const auto sun = day.sunLightAt(noon);
  const double onto = skyIlluminance(day.sunAt(noon).elevation_deg) +
                      static_cast<double>(luminance(sun->colour) * sun->intensity * -sun->direction.y);
  const double up = static_cast<double>(luminance(skyAt(day, noon).from({0.3f, -0.9f, 0.3f}).rgb));
  EXPECT_NEAR(up, 0.15 * onto / M_PI, 0.01 * up);
}

TEST(DaySky, LightsAScene) {
  Scene scene;
  Material lamp;
  lamp.name = "lamp", lamp.emission = Vec3(2);
  scene.materials = {lamp};
  Day day;
  day.groups["lamp"] = {{0, Vec3(0.25f)}};
  lightAt(scene, day, 720);
  EXPECT_EQ(scene.materials[0].emission, Vec3(0.5f));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_FALSE(scene.environment.dark());
}

}  // namespace
}  // namespace relume::scene
