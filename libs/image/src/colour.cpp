// SPDX-License-Identifier: MIT
// Tone curves and colour maps. The maps are laid out in Oklab (B. Ottosson, A perceptual color space for
// image processing, 2020), where equal steps look about equal, and stay within the display's gamut. Based on:
// J. Hable, Uncharted 2: HDR Lighting, GDC 2010 (the filmic curve).
#include "relume/image/colour.h"

#include <algorithm>
#include <cmath>

namespace relume::image {
namespace {

constexpr float kHableWhite = 11.2f;

float hable(float x) {
  constexpr float kA = 0.15f, kB = 0.50f, kC = 0.10f, kD = 0.20f, kE = 0.02f, kF = 0.30f;
  return (x * (kA * x + kC * kB) + kD * kE) / (x * (kA * x + kB) + kD * kF) - kE / kF;
}

float shown(float v, ToneCurve curve) {
  if (!(v > 0.0f)) return 0.0f;
  v = std::min(v, 1e6f);  // the square in the curve stays finite
  return std::min(curve == ToneCurve::kFilmic ? hable(v) / hable(kHableWhite) : v, 1.0f);
}

Vec3 rgbFromOklab(Vec3 lab) {
  const float l = lab.x + 0.3963377774f * lab.y + 0.2158037573f * lab.z;
  const float m = lab.x - 0.1055613458f * lab.y - 0.0638541728f * lab.z;
  const float s = lab.x - 0.0894841775f * lab.y - 1.2914855480f * lab.z;
  const Vec3 lms(l * l * l, m * m * m, s * s * s);
  return {4.0767416621f * lms.x - 3.3077115913f * lms.y + 0.2309699292f * lms.z,
          -1.2684380046f * lms.x + 2.6097574011f * lms.y - 0.3413193965f * lms.z,
          -0.0041960863f * lms.x - 0.7034186147f * lms.y + 1.7076147010f * lms.z};
}

// The colour of this lightness and hue whose chroma is the largest in gamut up to `chroma`.
Vec3 inGamut(float lightness, float chroma, float hue) {
  const auto at = [&](float c) { return rgbFromOklab({lightness, c * std::cos(hue), c * std::sin(hue)}); };
  const auto fits = [](Vec3 rgb) {
    return glm::all(glm::greaterThanEqual(rgb, Vec3(0.0f))) && glm::all(glm::lessThanEqual(rgb, Vec3(1.0f)));
  };
  if (fits(at(chroma))) return at(chroma);
  float lo = 0.0f, hi = chroma;
  for (int i = 0; i < 20; ++i) (fits(at(0.5f * (lo + hi))) ? lo : hi) = 0.5f * (lo + hi);
  return glm::clamp(at(lo), 0.0f, 1.0f);
}

}  // namespace

Image toneMap(const Image& linear, ToneCurve curve, float exposure_stops) {
  Image out = linear;
  const float scale = std::exp2(exposure_stops);
  const auto channels = static_cast<std::size_t>(out.channels);
  const bool has_alpha = channels == 2 || channels == 4;
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const bool is_alpha = has_alpha && i % channels == channels - 1;
    float& v = out.data[i];
    v = is_alpha ? std::clamp(v, 0.0f, 1.0f) : shown(v * scale, curve);
  }
  return out;
}

Vec3 falseColour(float t) {
  t = t > 0.0f ? std::min(t, 1.0f) : 0.0f;
  // From blue-black over violet, red and orange to pale yellow, all the way inside the display's gamut; the
  // bend of the hue makes steps in CIE L*a*b* equal within a factor of 1.8.
  constexpr float kDarkest = 0.15f, kBrightest = 0.97f, kChroma = 0.18f, kChromaAtEnds = 0.02f;
  constexpr float kFirstHue = glm::radians(270.0f), kLastHue = glm::radians(445.0f), kHueBend = 0.8f;
  return inGamut(kDarkest + (kBrightest - kDarkest) * t, kChromaAtEnds + kChroma * std::sin(kPi * t),
                 kFirstHue + (kLastHue - kFirstHue) * std::pow(t, kHueBend));
}

Image falseColour(const Image& one_channel, float lo, float hi) {
  Image out(one_channel.width, one_channel.height, 3);
  const float scale = hi > lo ? 1.0f / (hi - lo) : 0.0f;
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) out.setRgb(x, y, falseColour((*one_channel.at(x, y) - lo) * scale));
  return out;
}

Vec3 labelColour(std::uint32_t label) {
  // Steps of the golden angle keep hues of any few successive labels apart; three lightnesses tell near hues
  // apart.
  constexpr std::uint32_t kGoldenAngle = 0x9e3779b9u;  // of 2^32
  constexpr float kLightness[3] = {0.72f, 0.56f, 0.86f};
  const float hue = 2.0f * kPi * static_cast<float>(label * kGoldenAngle) * 0x1p-32f;
  return inGamut(kLightness[label % 3], 0.15f, hue);
}

}  // namespace relume::image
