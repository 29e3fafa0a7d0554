// SPDX-License-Identifier: MIT
#include "relume/core/sun.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relume {
namespace {

constexpr double kTolerance = 0.05;  // degrees, half of what is promised
constexpr double kDegree = M_PI / 180;

struct Known {
  Place place;
  Date date;
  double utc, azimuth, elevation, apparent;
};

// Azimuth and elevation by NOAA's solar calculator, each checked against the Astronomical Almanac's formulas.
TEST(Sun, StandsWhereNoaaAndTheAlmanacHaveIt) {
  const Place kolding{55.49, 9.47}, sydney{-33.87, 151.21}, reykjavik{64.13, -21.9};
  const Date summer{2011, 6, 21}, winter{2011, 12, 21};
  const Known known[] = {{kolding, summer, 2.5, 41.8001, -1.6993, -1.505},
                         {kolding, summer, 4.0, 59.9603, 8.1620, 8.268},
                         {kolding, summer, 8.0, 109.4050, 40.9378, 40.956},
                         {kolding, summer, 11.0, 169.7541, 57.6457, 57.656},
                         {kolding, summer, 15.5, 260.4980, 35.1353, 35.158},
                         {kolding, summer, 19.0, 302.4666, 6.6676, 6.795},
                         {kolding, winter, 11.0, 175.3208, 10.9595, 11.040},
                         {sydney, {2024, 3, 20}, 2.0, 1.1552, 56.1423, 56.153},
                         {reykjavik, {2026, 9, 5}, 23.5, 329.8758, -16.0730, -16.053}};
  for (const Known& k : known) {
    SCOPED_TRACE(testing::Message() << k.date.year << "-" << k.date.month << " " << k.utc << " h");
    const SunPosition sun = sunPosition(k.place, k.date, k.utc);
    EXPECT_NEAR(sun.azimuth_deg, k.azimuth, kTolerance);
    EXPECT_NEAR(sun.elevation_deg, k.elevation, kTolerance);
    EXPECT_NEAR(sun.apparent_deg, k.apparent, kTolerance);
  }
}

// The worked example of Reda and Andreas, Solar Position Algorithm for Solar Radiation Applications, NREL
// 2003, appendix A.5: zenith 50.11162, azimuth 194.34024 degrees.
TEST(Sun, AgreesWithTheSolarPositionAlgorithm) {
  const SunPosition sun = sunPosition({39.742476, -105.1786}, {2003, 10, 17}, 12 + 30.5 / 60 + 7);
  EXPECT_NEAR(90 - sun.apparent_deg, 50.11162, kTolerance);
  EXPECT_NEAR(sun.azimuth_deg, 194.34024, kTolerance);
}

// cos H = (sin(-0.833) - sin lat sin dec) / (cos lat cos dec) with the declination of that day, 23.436
// degrees: H = 131.18 degrees, 8 h 44.7 min about noon, which the equation of time (-1.70 min) puts at 11 h
// 23.8 min UTC.
TEST(Sun, RisesAndSetsByTheHourAngle) {
  constexpr double kMinute = 1.0 / 60;
  const SunTimes times = sunTimes({55.49, 9.47}, {2011, 6, 21});
  ASSERT_TRUE(times.rise && times.set);
  EXPECT_NEAR(times.noon, 11 + 23.8 * kMinute, 0.2 * kMinute);
  EXPECT_NEAR(*times.rise, 2 + 39.1 * kMinute, 0.5 * kMinute);
  EXPECT_NEAR(*times.set, 20 + 8.5 * kMinute, 0.5 * kMinute);
}

// Another way, by sidereal time instead of the equation of time (Michalsky 1988), through the years.
TEST(Sun, AgreesWithSiderealTimeAllYear) {
  for (int year = 1960; year <= 2045; year += 17)
    for (int month = 1; month <= 12; ++month) {
      const Place place{70.0 - 11.0 * month, -170.0 + 28.0 * month};
      const Date date{year, month, 3 + 2 * month};
      const double utc = 1.9 * month;
      const int y = month <= 2 ? year - 1 : year, m = month <= 2 ? month + 12 : month;
      const double days = std::floor(365.25 * (y + 4716)) + std::floor(30.6001 * (m + 1)) + date.day +
                          (2 - y / 100 + y / 400) - 1524.5 + utc / 24 - 2451545.0;
      const double l = 280.460 + 0.9856474 * days, g = (357.528 + 0.9856003 * days) * kDegree;
      const double lambda = (l + 1.915 * std::sin(g) + 0.020 * std::sin(2 * g)) * kDegree;
      const double obliquity = (23.439 - 0.0000004 * days) * kDegree;
      const double ascension = std::atan2(std::cos(obliquity) * std::sin(lambda), std::cos(lambda));
      const double declination = std::asin(std::sin(obliquity) * std::sin(lambda));
      const double hour =
          (6.697375 + 0.0657098242 * days + utc) * 15 * kDegree + place.longitude_deg * kDegree - ascension;
      const double lat = place.latitude_deg * kDegree;
      const double sine =
          std::sin(lat) * std::sin(declination) + std::cos(lat) * std::cos(declination) * std::cos(hour);
      EXPECT_NEAR(sunPosition(place, date, utc).elevation_deg, std::asin(sine) / kDegree, kTolerance)
          << year << "-" << month;
    }
}

TEST(Sun, NeitherRisesInPolarNightNorSetsInPolarDay) {
  const Place tromso{69.65, 18.96};
  EXPECT_FALSE(sunTimes(tromso, {2020, 12, 21}).rise);
  EXPECT_FALSE(sunTimes(tromso, {2020, 6, 21}).set);
  EXPECT_TRUE(sunTimes(tromso, {2020, 3, 21}).rise);
}

TEST(Sun, DirectionsGoByTheCompass) {
  const auto expectNear = [](Direction a, Direction b) { EXPECT_LT(glm::length(a - b), 1e-6f); };
  expectNear(skyDirection(0, 0, 0), {0, 0, -1});
  expectNear(skyDirection(90, 0, 0), {1, 0, 0});
  expectNear(skyDirection(123, 90, 17), {0, 1, 0});
  expectNear(skyDirection(135, 0, 45), {1, 0, 0});  // -Z looks to the north-east, +X to the south-east
}

TEST(Sun, KnowsTheCalendar) {
  EXPECT_EQ(dayOfYear({2024, 12, 31}), 366);
  EXPECT_EQ(dayOfYear({1900, 3, 1}), 60);
  EXPECT_TRUE(isValid({2000, 2, 29}));
  EXPECT_FALSE(isValid({1900, 2, 29}));
  EXPECT_FALSE(isValid({2011, 13, 1}));
}

}  // namespace
}  // namespace relume
