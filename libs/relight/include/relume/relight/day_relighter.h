// SPDX-License-Identifier: MIT
// Light of any minute of a baked day: two keyframes interpolated, each a sum of eigen-images. What comes
// straight from the sun and from lamps is added live: Day::lightsAt says what shines.
#pragma once
#include <span>
#include <vector>

#include "relume/asset/day_frames.h"
#include "relume/core/day.h"
#include "relume/core/quantity.h"

namespace relume::relight {

class DayRelighter {
 public:
  /// Throws Error kMismatch where `layer` is not of kind day, kCorruptAsset, kInvalidValue.
  DayRelighter(const asset::Asset& asset, const asset::Layer& layer);

  const Day& day() const { return day_; }
  const asset::DayFrames& frames() const { return frames_; }

  /// Reflected and sky light on each receiver: texels of the atlas table, or pixels. Valid until the next
  /// call.
  std::span<const Irradiance> evaluate(double minutes);

 private:
  Day day_;
  asset::DayFrames frames_;
  std::vector<float> gains_, values_;
  std::vector<Irradiance> result_;
};

}  // namespace relume::relight
