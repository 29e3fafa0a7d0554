// SPDX-License-Identifier: MIT
#include "light_paths/exit_substitutes.h"

#include <algorithm>

namespace relume::transport {

std::vector<std::uint32_t> gatheredFrom(const Patches& exits, const Sides& sides) {
  constexpr int kRings = 8;  // of blocks
  std::vector<std::uint32_t> from(exits.size());
  struct Key {
    std::uint32_t page, y, x, chart;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<std::pair<Key, std::uint32_t>> open;
  std::vector<std::uint32_t> buried;
  for (std::uint32_t i = 0; i < exits.size(); ++i) {
    from[i] = i;
    const Patch& p = exits.all[i];
    if (sides.buried(exits.membersOf(i)[0])) {
      buried.push_back(i);
    } else {
      open.push_back({{p.page, p.y, p.x, p.chart}, i});
    }
  }
  std::sort(open.begin(), open.end());
  for (const std::uint32_t i : buried) {
    const Patch& p = exits.all[i];
    float best = kInfinity;
    for (int dy = -kRings; dy <= kRings; ++dy) {
      if (static_cast<int>(p.y) + dy < 0) continue;
      const auto y = static_cast<std::uint32_t>(static_cast<int>(p.y) + dy);
      const auto x = static_cast<std::uint32_t>(std::max(static_cast<int>(p.x) - kRings, 0));
      for (auto it = std::lower_bound(open.begin(), open.end(), std::pair(Key{p.page, y, x, 0}, 0u));
           it != open.end() && it->first.page == p.page && it->first.y == y && it->first.x <= p.x + kRings;
           ++it) {
        const Patch& q = exits.all[it->second];
        if (q.chart != p.chart || glm::dot(q.geometric_normal, p.geometric_normal) < 0.7f) continue;
        const float distance = glm::length(q.centre - p.centre);
        if (distance < best) best = distance, from[i] = it->second;
      }
    }
  }
  return from;
}

}  // namespace relume::transport
