// SPDX-License-Identifier: MIT
// Whether one frame can be told from another by eye.
#pragma once
#include <cstdint>
#include <span>

#include "day_receivers.h"

namespace relume::bake {

enum class DayMetric : std::uint8_t { kYee, kFlip };

class DayJudge {
 public:
  /// `unseen`: the share of the receivers that may differ visibly while nobody notices; `brightest`: typical
  /// luminance of the brightest frame. Keeps the reference.
  DayJudge(const DayReceivers& receivers, DayMetric metric, double unseen, float brightest)
      : receivers_(receivers),
        metric_(metric),
        unseen_(static_cast<std::size_t>(unseen * static_cast<double>(receivers.size()))),
        brightest_(brightest) {}

  /// What a frame is multiplied by to be looked at: its typical luminance becomes a mid grey. The eye adapts,
  /// but not to darkness a thousandth of the brightest frame.
  float exposure(std::span<const Vec3> frame) const;
  /// Shown with the exposure of the true one.
  bool visible(std::span<const Vec3> frame, std::span<const Vec3> truth) const;

 private:
  const DayReceivers& receivers_;
  DayMetric metric_;
  std::size_t unseen_;
  float brightest_;
};

}  // namespace relume::bake
