// SPDX-License-Identifier: MIT
#include "relume/core/day.h"

#include <gtest/gtest.h>

#include "relume/core/daylight.h"

namespace relume {
namespace {

// Kasten and Young's own table: 1 at the zenith, 5.6 at 10 degrees, about 38 at the horizon.
TEST(Daylight, AirMassIsThatOfTheTables) {
  EXPECT_NEAR(airMass(90), 1.0, 0.001);
  EXPECT_NEAR(airMass(30), 1.9939, 0.002);
  EXPECT_NEAR(airMass(10), 5.5841, 0.01);
  EXPECT_NEAR(airMass(0), 37.92, 0.1);
}

// IES clear day: about 93 klx direct with the sun high, none at night; the lower the sun, the redder.
TEST(Daylight, TheSunDimsAndReddensTowardsTheHorizon) {
  const Vec3 high = sunIlluminance(60, 2.3, 172);
  EXPECT_NEAR(luminance(high), 127500 * 0.967 * std::exp(-0.21 / std::sin(kPi / 3)), 10000);
  float before = 0, blueness = -1;
  for (const double elevation : {0.1, 1.0, 3.0, 10.0, 30.0, 90.0}) {
    const Vec3 sun = sunIlluminance(elevation, 3, 172);
    EXPECT_GT(luminance(sun), before) << elevation;
    EXPECT_GE(sun.z / sun.x, blueness) << elevation;
    before = luminance(sun), blueness = sun.z / sun.x;
  }
  EXPECT_EQ(luminance(sunIlluminance(-0.3, 3, 172)), 0);
}

// Landmarks of twilight: some 800 lux at sunset, 3.4 at the end of civil twilight, 0.0006 of astronomical.
TEST(Daylight, TheSkyIsContinuousFromNoonToNight) {
  EXPECT_NEAR(skyIlluminance(-6), 3.6, 0.4);
  EXPECT_LT(skyIlluminance(-17.9), 0.001);
  EXPECT_EQ(skyIlluminance(-18.1), 0);
  EXPECT_NEAR(skyIlluminance(90), 16300, 1);
  double before = 0;
  for (double e = -17.99; e < 90; e += 0.01) {
    const double now = skyIlluminance(e);
    EXPECT_GE(now, 0.995 * before) << e;
    if (e < -0.02 || e > 0.5) {
      EXPECT_LT(now, 1.05 * before + 1e-3) << e;
    }
    before = now;
  }
}

Light lamp(const char* name) {
  Light light;
  light.name = name, light.intensity = 10, light.position = {1, 2, 3};
  return light;
}

// A row of lamp posts that lights at dusk and goes out at dawn: the night passes midnight.
TEST(Day, GroupsFollowTheirTimetableOverMidnight) {
  Day day;
  day.groups["posts"] = {{300, Vec3(1)}, {310, Vec3(0)}, {1260, Vec3(0)}, {1290, Vec3(1, 0.5f, 0)}};
  EXPECT_EQ(day.gainAt("posts", 800), Vec3(0));
  EXPECT_EQ(day.gainAt("posts", 1275), Vec3(0.5f, 0.25f, 0));
  EXPECT_NEAR(day.gainAt("posts", 305).x, 0.5f, 1e-6f);
  // 1290 to 300 is 450 minutes; midnight is 150 after.
  EXPECT_NEAR(day.gainAt("posts", 1440).y, 0.5f + 0.5f * 150 / 450, 1e-5f);
  EXPECT_NEAR(day.gainAt("posts", 0).y, 0.5f + 0.5f * 150 / 450, 1e-5f);
  EXPECT_EQ(day.gainAt("others", 800), Vec3(1));
}

TEST(Day, TwoKeysAtOneTimeAreASwitch) {
  Day day;
  day.groups["g"] = {{600, Vec3(0)}, {600, Vec3(1)}, {1200, Vec3(1)}, {1200, Vec3(0)}};
  EXPECT_EQ(day.gainAt("g", 599.99), Vec3(0));
  EXPECT_EQ(day.gainAt("g", 600), Vec3(1));
  EXPECT_EQ(day.gainAt("g", 1199.99), Vec3(1));
  EXPECT_EQ(day.gainAt("g", 1200), Vec3(0));
  EXPECT_EQ(day.gainAt("g", 0), Vec3(0));
}

TEST(Day, LampsMoveAndAreDimmed) {
  Day day;
  KeyedLight keyed{lamp("lantern"), {}};
  keyed.keys.push_back({.minutes = 60, .intensity = 0.0f, .position = Point(0, 0, 0)});
  keyed.keys.push_back({.minutes = 90, .position = Point(0, 0, 30)});
  keyed.keys.push_back({.minutes = 120, .intensity = 60.0f});
  day.lights = {keyed};
  const LightSet at90 = day.lampsAt({lamp("scene's own")}, 90);
  ASSERT_EQ(at90.size(), 1u);
  EXPECT_NEAR(at90[0].intensity, 30, 1e-4f);  // the key without intensity is passed over
  EXPECT_NEAR(at90[0].position.z, 30, 1e-4f);
  EXPECT_NEAR(day.lampsAt({}, 75)[0].position.z, 15, 1e-4f);
  EXPECT_TRUE(day.lampsAt({}, 60).empty()) << "dark lamps are left out";
}

TEST(Day, ReplacesTheScenesSunAndKeepsItsLamps) {
  Day day;
  day.utc_offset = 2;
  Light old_sun = lamp("sun");
  old_sun.kind = Light::Kind::kDirectional;
  const LightSet noon = day.lightsAt({lamp("lamp"), old_sun}, 13.4 * 60);
  ASSERT_EQ(noon.size(), 2u);
  EXPECT_EQ(noon[0].name, "lamp");
  EXPECT_EQ(noon[1].name, "sun");
  EXPECT_NEAR(std::asin(-noon[1].direction.y) * 180 / kPi, 57.957f, 0.1f);
  EXPECT_GT(noon[1].direction.z, -0.6f);
  EXPECT_LT(noon[1].direction.z, -0.5f) << "at noon sunlight travels north, to -Z";
  EXPECT_EQ(day.lightsAt({}, 0).size(), 0u) << "the sun is down at midnight";
}

TEST(Day, BreaksAreWhereLightChangesItsCourse) {
  Day day;
  day.utc_offset = 2;
  day.groups["g"] = {{1300, Vec3(0)}, {1310, Vec3(1)}};
  const std::vector<double> breaks = day.breaks();
  ASSERT_EQ(breaks.size(), 7u);  // begin, sunrise, noon, two keys, sunset, end
  EXPECT_NEAR(breaks[1], 4 * 60 + 39, 2);
  EXPECT_NEAR(breaks[2], 13 * 60 + 24, 1);
  EXPECT_NEAR(breaks[5], 22 * 60 + 8.5, 2);
}

// A switch needs light from just before it too.
TEST(Day, BreaksHaveBothSidesOfASwitch) {
  Day day;
  day.sun = false;
  day.groups["g"] = {{600, Vec3(0)}, {600, Vec3(1)}};
  const std::vector<double> breaks = day.breaks();
  ASSERT_EQ(breaks.size(), 4u);
  EXPECT_NEAR(day.gainAt("g", breaks[1]).x, 0, 1e-4f);
  EXPECT_EQ(day.gainAt("g", breaks[2]), Vec3(1));
}

TEST(Day, ReadsAndWritesTheClock) {
  EXPECT_EQ(clockMinutes("7:05"), 425);
  EXPECT_EQ(clockMinutes("24:00"), 1440);
  EXPECT_EQ(clockMinutes("12:30:30"), 750.5);
  for (const char* wrong : {"", "7", "7:5", "24:01", "12:60", "1:2:3:4", "a:10", "12:", ":30", "123:00"})
    EXPECT_FALSE(clockMinutes(wrong)) << wrong;
  EXPECT_EQ(clockText(425), "07:05");
  EXPECT_EQ(clockText(750.5), "12:30:30");
}

}  // namespace
}  // namespace relume
