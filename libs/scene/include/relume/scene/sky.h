// SPDX-License-Identifier: MIT
// The clear sky. Based on:
//   [PSS99] Preetham, Shirley, Smits. A Practical Analytic Model for Daylight. SIGGRAPH 1999, appendix A.2:
//   Perez's five-parameter distribution of luminance and chromaticity, fitted for turbidities 2 to 6.
// What differs: the sun itself is not in it (add a directional light), below the horizon it is black, and
// colours outside Rec. 709 are clipped.
// Limits: the sun above the horizon; no clouds, no twilight. Near turbidity 2 the sky around a low sun is too
// bright and too yellow, and beyond 6 the fit is an extrapolation (Zotti, Wilkie, Purgathofer, A Critical
// Review of the Preetham Skylight Model, 2007).
#pragma once
#include "relume/core/vec.h"
#include "relume/image/image.h"

namespace relume::scene {

/// Luminance of the sky in cd m^-2 as linear Rec. 709 RGB whose luminance() it is, so that it goes with a sun
/// in lux. `to_sun`: unit, towards the sun, y > 0; turbidity in [2, 10]. Throws Error kInvalidValue outside.
Vec3 skyLuminance(Direction to_sun, float turbidity, Direction d);

/// The whole sky as an equirectangular image of 2 height x height pixels (environment.h).
image::Image skyImage(Direction to_sun, float turbidity, int height = 256);

}  // namespace relume::scene
