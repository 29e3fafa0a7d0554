// SPDX-License-Identifier: MIT
#include "relume/core/sun.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relume {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kRimAtHorizon = -0.833;  // degrees: half of the disk, and refraction
double sinDeg(double a) { return std::sin(a * kDegree); }
double cosDeg(double a) { return std::cos(a * kDegree); }
double tanDeg(double a) { return std::tan(a * kDegree); }

bool isLeap(int year) { return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0; }

int daysOf(int year, int month) {
  constexpr std::array kDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return kDays[static_cast<std::size_t>(month - 1)] + (month == 2 && isLeap(year) ? 1 : 0);
}

/// [Meeus98] (7.1).
double julianDay(const Date& date, double utc_hours) {
  int y = date.year, m = date.month;
  if (m <= 2) --y, m += 12;
  const int century = static_cast<int>(std::floor(y / 100.0));
  const int correction = 2 - century + static_cast<int>(std::floor(century / 4.0));
  return std::floor(365.25 * (y + 4716)) + std::floor(30.6001 * (m + 1)) + date.day + correction - 1524.5 +
         utc_hours / 24;
}

struct Ephemeris {
  double declination_deg, equation_of_time;  // the latter in minutes
};

/// [Meeus98] chapters 22, 25 and (28.3).
Ephemeris ephemeris(const Date& date, double utc_hours) {
  const double t = (julianDay(date, utc_hours) - 2451545.0) / 36525;  // centuries since 2000
  const double mean_longitude = std::fmod(280.46646 + t * (36000.76983 + t * 0.0003032), 360.0);
  const double anomaly = 357.52911 + t * (35999.05029 - 0.0001537 * t);
  const double eccentricity = 0.016708634 - t * (0.000042037 + 0.0000001267 * t);
  const double centre = sinDeg(anomaly) * (1.914602 - t * (0.004817 + 0.000014 * t)) +
                        sinDeg(2 * anomaly) * (0.019993 - 0.000101 * t) + sinDeg(3 * anomaly) * 0.000289;
  const double node = 125.04 - 1934.136 * t;
  const double longitude = mean_longitude + centre - 0.00569 - 0.00478 * sinDeg(node);
  const double obliquity =
      23 + (26 + (21.448 - t * (46.815 + t * (0.00059 - t * 0.001813))) / 60) / 60 + 0.00256 * cosDeg(node);
  const double y = std::pow(tanDeg(obliquity / 2), 2);
  const double equation = y * sinDeg(2 * mean_longitude) - 2 * eccentricity * sinDeg(anomaly) +
                          4 * eccentricity * y * sinDeg(anomaly) * cosDeg(2 * mean_longitude) -
                          0.5 * y * y * sinDeg(4 * mean_longitude) -
                          1.25 * eccentricity * eccentricity * sinDeg(2 * anomaly);
  constexpr double kMinutesPerDegree = 4;
  return {std::asin(sinDeg(obliquity) * sinDeg(longitude)) / kDegree, kMinutesPerDegree * equation / kDegree};
}

/// Degrees by which the air lifts what stands at that elevation.
double refraction(double elevation) {
  double seconds = 0;
  if (elevation > 85) return 0;
  if (elevation > 5) {
    const double t = tanDeg(elevation);
    seconds = 58.1 / t - 0.07 / (t * t * t) + 0.000086 / std::pow(t, 5);
  } else if (elevation > -0.575) {
    seconds = 1735 + elevation * (-518.2 + elevation * (103.4 + elevation * (-12.79 + elevation * 0.711)));
  } else {
    seconds = -20.774 / tanDeg(elevation);
  }
  return seconds / 3600;
}

}  // namespace

bool isValid(const Date& date) {
  return date.year >= 1800 && date.year <= 2200 && date.month >= 1 && date.month <= 12 && date.day >= 1 &&
         date.day <= daysOf(date.year, date.month);
}

int dayOfYear(const Date& date) {
  int day = date.day;
  for (int m = 1; m < date.month; ++m) day += daysOf(date.year, m);
  return day;
}

SunPosition sunPosition(const Place& place, const Date& date, double utc_hours) {
  const Ephemeris e = ephemeris(date, utc_hours);
  const double hour_angle =
      (utc_hours * 60 + e.equation_of_time + 4 * place.longitude_deg) / 4 - 180;  // degrees
  const double lat = place.latitude_deg, dec = e.declination_deg;
  SunPosition sun{.declination_deg = dec};
  sun.elevation_deg =
      std::asin(
          std::clamp(sinDeg(lat) * sinDeg(dec) + cosDeg(lat) * cosDeg(dec) * cosDeg(hour_angle), -1.0, 1.0)) /
      kDegree;
  sun.azimuth_deg = std::atan2(-cosDeg(dec) * sinDeg(hour_angle),
                               sinDeg(dec) * cosDeg(lat) - cosDeg(dec) * cosDeg(hour_angle) * sinDeg(lat)) /
                    kDegree;
  if (sun.azimuth_deg < 0) sun.azimuth_deg += 360;
  sun.apparent_deg = sun.elevation_deg + refraction(sun.elevation_deg);
  return sun;
}

SunTimes sunTimes(const Place& place, const Date& date) {
  SunTimes times;
  times.noon = 12 - place.longitude_deg / 15;
  times.noon -= ephemeris(date, times.noon).equation_of_time / 60;
  const auto above = [&](double hours) {
    return sunPosition(place, date, hours).elevation_deg > kRimAtHorizon;
  };
  // Between midnight and noon the sun only rises, but for seconds of arc near the poles.
  const auto crossing = [&](double night) -> std::optional<double> {
    double low = night, high = times.noon;
    if (above(low) || !above(high)) return {};
    for (int i = 0; i < 40; ++i) (above(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    return 0.5 * (low + high);
  };
  times.rise = crossing(times.noon - 12), times.set = crossing(times.noon + 12);
  return times;
}

Direction skyDirection(double azimuth_deg, double elevation_deg, double heading_deg) {
  const double a = azimuth_deg - heading_deg;
  return Direction(sinDeg(a) * cosDeg(elevation_deg), sinDeg(elevation_deg),
                   -cosDeg(a) * cosDeg(elevation_deg));
}

}  // namespace relume
