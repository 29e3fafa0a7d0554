// SPDX-License-Identifier: MIT
// From linear light to something to look at.
#pragma once
#include <functional>

#include <cstdint>

#include "relume/image/image.h"

namespace relume::image {

enum class ToneCurve {
  kPlain,   ///< clamp
  kFilmic,  ///< Hable's curve (Uncharted 2), white at 11.2
};

/// Scales by 2^exposure_stops and maps to [0, 1], still linear (the PNG writer encodes sRGB).
Image toneMap(const Image& linear, ToneCurve curve, float exposure_stops = 0.0f);

/// Perceptually even dark-to-bright map (Turbo-like or magma), t in [0, 1] to linear RGB.
Vec3 falseColour(float t);
Image falseColour(const Image& one_channel, float lo, float hi);

/// A colour that tells neighbouring integers apart (charts, clusters), linear RGB.
Vec3 labelColour(std::uint32_t label);

}  // namespace relume::image
