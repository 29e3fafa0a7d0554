// SPDX-License-Identifier: MIT
#include "relume/basis/ggx.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/core/sampling.h"

namespace relume::basis::ggx {

float distribution(Vec3 h, float alpha) {
  // (n.h)^2 (a^2 - 1) + 1 as a^2 cos^2 + sin^2: sharp lobes keep their digits.
  const float a2 = alpha * alpha;
  const float q = a2 * h.z * h.z + h.x * h.x + h.y * h.y;
  return a2 / (kPi * q * q);
}

float masking(float cosine, float alpha) {
  const float a2 = alpha * alpha;
  return 2 * cosine / (cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine));
}

float visibility(float cos_i, float cos_o, float alpha) {
  const float a2 = alpha * alpha;
  const float below =
      cos_i * std::sqrt(a2 + (1 - a2) * cos_o * cos_o) + cos_o * std::sqrt(a2 + (1 - a2) * cos_i * cos_i);
  return below > 0 ? 0.5f / below : 0.0f;
}

Vec3 sampleVisibleNormal(Vec3 o, float alpha, Vec2 u) {
  const Vec3 stretched = glm::normalize(Vec3(alpha * o.x, alpha * o.y, o.z));
  const float phi = 2 * kPi * u.x;
  const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
  const float sine = std::sqrt(std::clamp(1 - z * z, 0.0f, 1.0f));
  const Vec3 h = Vec3(sine * std::cos(phi), sine * std::sin(phi), z) + stretched;
  return glm::normalize(Vec3(alpha * h.x, alpha * h.y, std::max(h.z, 1e-9f)));
}

namespace {

constexpr std::size_t kSize = 32;
constexpr std::uint32_t kSamples = 1024;

// Entries lie at cos = t^2 and alpha = s^2, t and s from 0 to 1: closer where the lobe is sharp and grazing.
float coordinate(std::size_t i) {
  const float t = static_cast<float>(i) / static_cast<float>(kSize - 1);
  return std::max(t * t, 1e-4f);
}

Reflected integrate(float cos_o, float alpha) {
  const Vec3 o(std::sqrt(std::max(0.0f, 1 - cos_o * cos_o)), 0, cos_o);
  double scale = 0, bias = 0;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const Vec3 h = sampleVisibleNormal(o, alpha, sobol2(i, 0));
    const float o_h = glm::dot(o, h);
    const Vec3 in = 2 * o_h * h - o;
    if (!(in.z > 0) || !(o_h > 0)) continue;
    // f cos / pdf = G2 / G1(o).
    const double share = visibility(in.z, cos_o, alpha) * 4 * in.z * cos_o / masking(cos_o, alpha);
    const double fresnel = std::pow(1 - o_h, 5);
    scale += share * (1 - fresnel), bias += share * fresnel;
  }
  return {static_cast<float>(scale / kSamples), static_cast<float>(bias / kSamples)};
}

struct Table {
  std::array<std::array<Reflected, kSize>, kSize> entry;  // [alpha][cos]
  Table() {
    for (std::size_t a = 0; a < kSize; ++a)
      for (std::size_t c = 0; c < kSize; ++c) entry[a][c] = integrate(coordinate(c), coordinate(a));
  }
};

}  // namespace

Reflected reflected(float cos_o, float alpha) {
  static const Table table;
  const auto place = [](float x) {
    return std::sqrt(std::clamp(x, 0.0f, 1.0f)) * static_cast<float>(kSize - 1);
  };
  const float x = place(cos_o), y = place(alpha);
  const auto x0 = std::min(static_cast<std::size_t>(x), kSize - 2),
             y0 = std::min(static_cast<std::size_t>(y), kSize - 2);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const auto mix = [&](float Reflected::*part) {
    const auto row = [&](std::size_t r) {
      return glm::mix(table.entry[r][x0].*part, table.entry[r][x0 + 1].*part, fx);
    };
    return glm::mix(row(y0), row(y0 + 1), fy);
  };
  return {mix(&Reflected::scale), mix(&Reflected::bias)};
}

}  // namespace relume::basis::ggx
