// SPDX-License-Identifier: MIT
// Where the sun stands. Based on:
//   [Meeus98] J. Meeus. Astronomical Algorithms, 2nd ed. 1998. Chapters 7, 22, 25 and 28, as NOAA's solar
//   calculator uses them; refraction in three pieces as given there by NOAA.
// What holds: within 0.03 degrees of the full theory from 1950 to 2050, parallax (0.0025 degrees) left out.
// Refraction is that of air at 10 degrees C and 1010 hPa; near the horizon weather moves it by 0.1 degrees.
#pragma once
#include <optional>

#include "relume/core/vec.h"

namespace relume {

struct Date {
  int year = 2011, month = 6, day = 21;  ///< Gregorian
  bool operator==(const Date&) const = default;
};
/// 1 on the first of January.
int dayOfYear(const Date& date);
bool isValid(const Date& date);

struct Place {
  double latitude_deg = 0, longitude_deg = 0;  ///< north and east are positive
};

struct SunPosition {
  double azimuth_deg = 0;    ///< clockwise from true north, [0, 360)
  double elevation_deg = 0;  ///< of the disk's centre above the horizon, without refraction
  double apparent_deg = 0;   ///< the same as seen through the air
  double declination_deg = 0;
};
/// utc_hours may lie outside [0, 24).
SunPosition sunPosition(const Place& place, const Date& date, double utc_hours);

/// In hours UTC about the noon of `date` at the place, so perhaps below 0 or above 24.
struct SunTimes {
  double noon = 0;                  ///< when the sun is highest
  std::optional<double> rise, set;  ///< the upper rim at the horizon (-0.833 degrees); none: it never is
};
SunTimes sunTimes(const Place& place, const Date& date);

/// Towards azimuth and elevation: +Y up; -Z looks to `heading_deg` (0: north), +X 90 degrees further
/// clockwise.
Direction skyDirection(double azimuth_deg, double elevation_deg, double heading_deg);

}  // namespace relume
