// SPDX-License-Identifier: MIT
// How much light sun and clear sky give, by the sun's elevation. Based on:
//   [IES84] Gillette, Pierpoint, Treado. A General Illuminance Model for Daylight Availability. Journal of
//   the IES 13, 1984 (IES RP-21): extraterrestrial illuminance, horizontal illuminance of the clear sky.
//   [PSS99] Preetham, Shirley, Smits. A Practical Analytic Model for Daylight. SIGGRAPH 1999, appendix A.1:
//   what the air lets through, by wavelength and turbidity.
//   [KY89] Kasten, Young. Revised optical air mass tables. Applied Optics 28, 1989.
//   [JD87] Janiczek, DeYoung. Computer Programs for Sun and Moon Illuminance. US Naval Observatory Circular
//   171, 1987: illuminance of twilight.
//   [WSS13] Wyman, Sloan, Shirley. Simple Analytic Approximations to the CIE XYZ Color Matching Functions.
//   JCGT 2(2), 2013.
// What differs: outside the air the sun is a black body of 5778 K; ozone, gases and water vapour are left out
// (some 3 %). No moon, no stars, no clouds.
#pragma once
#include "relume/core/sun.h"
#include "relume/core/vec.h"

namespace relume {

/// Illuminance on a plane that faces the sun, lux, as linear Rec. 709 whose luminance it is. While the disk
/// sets, what is left of it above the horizon; 0 below. Turbidity in [2, 10].
Vec3 sunIlluminance(double apparent_elevation_deg, double turbidity, int day_of_year);

/// Illuminance by the clear sky without the sun on a horizontal plane, lux: [IES84] by day, the course of
/// [JD87] in twilight; 0 when the sun is 18 degrees or more below the horizon. Continuous and
/// increasing but for 0.4 % where the pieces of the fit meet.
double skyIlluminance(double elevation_deg);

/// Relative optical air mass of an apparent elevation from 0 degrees up ([KY89]): 1 at the zenith, 38 at the
/// horizon.
double airMass(double apparent_elevation_deg);

inline constexpr float kSunAngularRadius = 0.004654f;  ///< radians

}  // namespace relume
