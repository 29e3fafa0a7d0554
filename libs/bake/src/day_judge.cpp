// SPDX-License-Identifier: MIT
#include "day_judge.h"

#include <algorithm>

#include "relume/image/colour.h"
#include "relume/image/metrics.h"

namespace relume::bake {
namespace {

constexpr float kMidGrey = 0.18f;
constexpr float kDarkest = 1.0f / 1024;  // of the brightest frame
// FLIP has no threshold of its own: a difference that a hundredth of the pixels exceeds.
constexpr double kVisibleFlip = 0.05;

}  // namespace

float DayJudge::exposure(std::span<const Vec3> frame) const {
  return kMidGrey / std::max({receivers_.typical(frame), kDarkest * brightest_, 1e-30f});
}

bool DayJudge::visible(std::span<const Vec3> frame, std::span<const Vec3> truth) const {
  const float e = exposure(truth);
  const image::Image a = receivers_.picture(frame, e), b = receivers_.picture(truth, e);
  if (a.data == b.data) return false;
  if (metric_ == DayMetric::kYee) return image::yee(a, b).visible_pixels > unseen_;
  return image::flip(image::toneMap(a, image::ToneCurve::kPlain), image::toneMap(b, image::ToneCurve::kPlain))
             .p99 > kVisibleFlip;
}

}  // namespace relume::bake
