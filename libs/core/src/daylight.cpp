// SPDX-License-Identifier: MIT
#include "relume/core/daylight.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/core/quantity.h"

namespace relume {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kSolarIlluminance = 127500;  // lux, [IES84]
constexpr double kSunTemperature = 5778;      // kelvin

/// A lobe of [WSS13]: a Gaussian with a width on either side.
double lobe(double nm, double middle, double below, double above) {
  const double t = (nm - middle) / (nm < middle ? below : above);
  return std::exp(-0.5 * t * t);
}

glm::dvec3 matching(double nm) {
  return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
              0.065 * lobe(nm, 501.1, 20.4, 26.2),
          0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
          1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

double blackBody(double nm) {
  constexpr double kSecond = 1.438777e7;  // nm kelvin
  return std::pow(nm / 560.0, -5.0) / std::expm1(kSecond / (nm * kSunTemperature));
}

/// CIE XYZ of the sun through so much air, in the units of blackBody.
glm::dvec3 sunXyz(double air_mass, double turbidity) {
  const double beta = 0.04608 * turbidity - 0.04586;  // Angstrom's
  glm::dvec3 sum(0.0);
  for (double nm = 360; nm <= 830; nm += 5) {
    const double um = nm * 1e-3;
    const double depth = 0.008735 * std::pow(um, -4.08) + beta * std::pow(um, -1.3);
    sum += matching(nm) * (blackBody(nm) * std::exp(-depth * air_mass));
  }
  return sum;
}

/// Share of the disk's area above the horizon.
double diskAbove(double apparent_elevation_deg) {
  const double x =
      std::clamp(apparent_elevation_deg * kDegree / static_cast<double>(kSunAngularRadius), -1.0, 1.0);
  return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / M_PI;
}

/// Lux on a horizontal plane from sky and sun together, [JD87].
double twilightIlluminance(double elevation_deg) {
  constexpr std::array<std::array<double, 5>, 4> kPieces{{{-0.8, 2.88, 22.26, -207.64, 1034.30},
                                                          {-5, 2.88, 21.81, -258.11, -858.36},
                                                          {-12, 2.70, 12.17, -431.69, -1899.83},
                                                          {-18, 13.84, 262.72, 1447.42, 2797.93}}};
  const double x = elevation_deg / 90;
  for (const auto& [from, l0, l1, l2, l3] : kPieces)
    if (elevation_deg >= from) return std::pow(10.0, l0 + x * (l1 + x * (l2 + x * l3)));
  return 0;
}

}  // namespace

double airMass(double apparent_elevation_deg) {
  const double h = std::max(apparent_elevation_deg, 0.0);
  return 1 / (std::sin(h * kDegree) + 0.50572 * std::pow(h + 6.07995, -1.6364));
}

Vec3 sunIlluminance(double apparent_elevation_deg, double turbidity, int day_of_year) {
  const double above = diskAbove(apparent_elevation_deg);
  if (above <= 0) return Vec3(0.0f);
  static const double outside = sunXyz(0, 2).y;
  const double orbit = 1 + 0.034 * std::cos(2 * M_PI * (day_of_year - 2) / 365);
  const glm::dvec3 xyz =
      sunXyz(airMass(apparent_elevation_deg), turbidity) * (above * kSolarIlluminance * orbit / outside);
  const glm::dvec3 rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                       -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                       0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
  // A red sun is outside Rec. 709; its luminance is kept.
  const Vec3 inside = glm::max(Vec3(rgb), Vec3(0.0f));
  return inside * (static_cast<float>(xyz.y) / std::max(luminance(inside), 1e-30f));
}

double skyIlluminance(double elevation_deg) {
  constexpr double kAtHorizon = 800;
  if (elevation_deg >= 0)
    return kAtHorizon + 15500 * std::sqrt(std::sin(std::min(elevation_deg, 90.0) * kDegree));
  return kAtHorizon * twilightIlluminance(elevation_deg) / twilightIlluminance(0);
}

}  // namespace relume
