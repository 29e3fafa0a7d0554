// SPDX-License-Identifier: MIT
#include "probe_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/basis/sh9.h"

namespace relume::relight {
namespace {

constexpr float kBehind = 0.02f;  // least weight of a probe behind the plane

}  // namespace

Irradiance ProbeField::at(Point p, Normal n, std::span<const Irradiance> rows) const {
  const auto& count = probes_.count;
  std::array<std::size_t, 3> low{}, high{};
  Vec3 part(0);
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const float at = std::clamp((p[axis] - probes_.origin[axis]) / probes_.spacing, 0.0f,
                                static_cast<float>(count[a] - 1));
    low[a] = static_cast<std::size_t>(at);
    high[a] = std::min<std::size_t>(low[a] + 1, count[a] - 1);
    part[axis] = at - static_cast<float>(low[a]);
  }
  std::array<Vec3, basis::kSh9> sum{};
  float weights = 0;
  for (int corner = 0; corner < 8; ++corner) {
    std::array<std::size_t, 3> cell{};
    float weight = 1;
    Point at(0);
    for (std::size_t a = 0; a < 3; ++a) {
      const bool up = ((corner >> a) & 1) != 0;
      const int axis = static_cast<int>(a);
      cell[a] = up ? high[a] : low[a];
      weight *= up ? part[axis] : 1 - part[axis];
      at[axis] = probes_.origin[axis] + probes_.spacing * static_cast<float>(cell[a]);
    }
    const std::uint32_t probe = probes_.probe[(cell[2] * count[1] + cell[1]) * count[0] + cell[0]];
    if (!(weight > 0) || probe == asset::ProbeExits::kNoProbe) continue;
    const Vec3 way = at - p;
    const float length = glm::length(way);
    const float facing = length > 0 ? 0.5f + 0.5f * glm::dot(way, n) / length : 1.0f;
    weight *= facing * facing + kBehind;
    for (std::size_t k = 0; k < basis::kSh9; ++k)
      sum[k] += weight * rows[probe * asset::ProbeExits::kRows + k].rgb;
    weights += weight;
  }
  if (!(weights > 0)) return Irradiance(0.0f);
  const auto y = basis::sh9(n);
  Vec3 e(0);
  for (std::size_t k = 0; k < basis::kSh9; ++k) e += y[k] * sum[k];
  return Irradiance(glm::max(e / weights, Vec3(0)));
}

}  // namespace relume::relight
