// SPDX-License-Identifier: MIT
#include "light_paths/typical_light.h"

#include <cmath>

#include "light_paths/members.h"
#include "relume/core/parallel.h"
#include "relume/core/quantity.h"

namespace relume::transport {
namespace {

constexpr int kMostReflections = 64;
constexpr double kResidual = 1e-3;
constexpr float kUncertain = 0.1f;   // share of the mean that a shape always has
constexpr std::size_t kGrain = 256;  // pieces

}  // namespace

std::vector<float> areasOf(const Sides& sides, const Pieces& pieces) {
  std::vector<float> area(pieces.size(), 0.0f);
  for (std::size_t side = 0; side < sides.size(); ++side)
    if (pieces.of_side[side] != scene::kNone) area[pieces.of_side[side]] += sides.area(side);
  return area;
}

std::vector<float> reflectedLight(const Sides& sides, const Pieces& pieces,
                                  const MeanReflectance& reflectance, std::span<const float> direct,
                                  Progress& progress) {
  const std::vector<float> area = areasOf(sides, pieces);
  const Members members = membersOf(pieces.of_side, pieces.size());
  std::vector<float> light(pieces.size(), 0.0f), next(pieces.size());
  for (int reflection = 0; reflection < kMostReflections; ++reflection) {
    progress.throwIfCancelled();
    parallelFor(pieces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t piece = begin; piece < end; ++piece) {
        float sum = 0;
        for (const std::uint32_t side : members.of(piece)) {
          float seen = 0;
          for (const SideOfTexel ray : sides.ends(side)) {
            const std::uint32_t met = sides.answering(ray);
            if (met == scene::kNone || pieces.of_side[met] == scene::kNone) continue;
            const std::uint32_t point = sides.point(met), from = pieces.of_side[met];
            seen += luminance(reflectance.value[point]) *
                    (reflectance.direct[point] * direct[from] + light[from]);
          }
          sum += sides.area(side) * seen;
        }
        next[piece] = area[piece] > 0 ? sum / (area[piece] * static_cast<float>(sides.raysEach())) : 0.0f;
      }
    });
    double change = 0, all = 0;
    for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
      change += static_cast<double>(area[piece] * std::abs(next[piece] - light[piece]));
      all += static_cast<double>(area[piece] * next[piece]);
    }
    light.swap(next);
    if (!(change > kResidual * all)) break;
  }
  return light;
}

std::vector<float> shapeWithin(std::span<const std::uint32_t> group, std::size_t groups,
                               std::span<const float> weight, std::span<const float> light) {
  std::vector<double> sum(groups, 0.0), all(groups, 0.0);
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (group[i] == scene::kNone) continue;
    sum[group[i]] += static_cast<double>(weight[i]) * static_cast<double>(light[i]);
    all[group[i]] += static_cast<double>(weight[i]);
  }
  std::vector<float> shape(group.size(), 1.0f);
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (group[i] == scene::kNone || !(sum[group[i]] > 0)) continue;
    const auto relative = static_cast<float>(static_cast<double>(light[i]) * all[group[i]] / sum[group[i]]);
    shape[i] = (relative + kUncertain) / (1.0f + kUncertain);
  }
  return shape;
}

}  // namespace relume::transport
