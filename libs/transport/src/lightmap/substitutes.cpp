// SPDX-License-Identifier: MIT
// Ring by ring: a buried texel next to an answered one takes its answer. Rings are closed before the next one
// starts, so the result does not depend on the order within.
#include "lightmap/substitutes.h"

#include <utility>

namespace relume::transport {
namespace {

constexpr int kRings = 3;  // texels

}  // namespace

std::vector<std::uint32_t> substitutes(const atlas::Texels& texels, std::span<const std::uint8_t> buried) {
  std::vector<std::uint32_t> answer(texels.points.size()), open;
  for (std::uint32_t i = 0; i < answer.size(); ++i) {
    answer[i] = buried[i] ? scene::kNone : i;
    if (buried[i]) open.push_back(i);
  }
  if (open.empty()) return answer;

  const auto width = static_cast<std::size_t>(texels.width), height = static_cast<std::size_t>(texels.height);
  std::vector<std::uint32_t> point_of(texels.pages * width * height, scene::kNone);
  for (std::uint32_t i = 0; i < answer.size(); ++i) point_of[texels.points[i].texel] = i;
  const auto neighbour = [&](std::uint32_t point, int dx, int dy) {
    const std::size_t texel = texels.points[point].texel, x = texel % width, y = texel / width % height;
    if ((dx < 0 && x == 0) || (dx > 0 && x + 1 == width) || (dy < 0 && y == 0) || (dy > 0 && y + 1 == height))
      return scene::kNone;
    const std::uint32_t other = point_of[static_cast<std::size_t>(
        static_cast<std::ptrdiff_t>(texel) + dy * static_cast<std::ptrdiff_t>(width) + dx)];
    return other != scene::kNone && texels.points[other].chart == texels.points[point].chart ? other
                                                                                             : scene::kNone;
  };
  constexpr std::pair<int, int> kAround[] = {{-1, 0},  {1, 0},  {0, -1}, {0, 1},
                                             {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
  for (int ring_number = 0; ring_number < kRings && !open.empty(); ++ring_number) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ring;
    std::vector<std::uint32_t> rest;
    for (const std::uint32_t i : open) {
      std::uint32_t found = scene::kNone;
      for (const auto& [dx, dy] : kAround) {
        const std::uint32_t other = neighbour(i, dx, dy);
        if (other != scene::kNone && answer[other] != scene::kNone) {
          found = answer[other];
          break;
        }
      }
      if (found == scene::kNone) {
        rest.push_back(i);
      } else {
        ring.emplace_back(i, found);
      }
    }
    for (const auto& [i, found] : ring) answer[i] = found;
    open = std::move(rest);
  }
  for (const std::uint32_t i : open) answer[i] = i;
  return answer;
}

}  // namespace relume::transport
