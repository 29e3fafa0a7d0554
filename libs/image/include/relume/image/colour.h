// SPDX-License-Identifier: MIT
// From linear light to something to look at.
#pragma once
#include <cstdint>

#include "relume/image/image.h"

namespace relume::image {

enum class ToneCurve {
  kPlain,   ///< clamp
  kFilmic,  ///< Hable's curve (Uncharted 2), white at 11.2
};

/// Scales by 2^exposure_stops and maps to [0, 1], still linear (the PNG writer encodes sRGB). Alpha is not
/// scaled.
Image toneMap(const Image& linear, ToneCurve curve, float exposure_stops = 0.0f);

/// Perceptually even map from blue-black over violet, red and orange to pale yellow, t in [0, 1] to linear
/// RGB; t outside is clamped, NaN is 0.
Vec3 falseColour(float t);
/// lo is mapped to 0 and hi to 1. Returns 3 channels.
Image falseColour(const Image& one_channel, float lo, float hi);

/// A colour that tells neighbouring integers apart (charts, clusters), linear RGB.
Vec3 labelColour(std::uint32_t label);

}  // namespace relume::image
