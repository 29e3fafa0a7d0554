// SPDX-License-Identifier: MIT
// The members of groups, from the group of each member.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "relume/scene/scene.h"

namespace relume::transport {

struct Members {
  std::vector<std::uint32_t> first;  ///< by group, and one more
  std::vector<std::uint32_t> item;   ///< rising within a group
  std::span<const std::uint32_t> of(std::size_t group) const {
    return std::span(item).subspan(first[group], first[group + 1] - first[group]);
  }
};

/// group_of: scene::kNone for those in no group.
inline Members membersOf(std::span<const std::uint32_t> group_of, std::size_t groups) {
  Members m;
  m.first.assign(groups + 1, 0);
  for (const std::uint32_t g : group_of)
    if (g != scene::kNone) ++m.first[g + 1];
  for (std::size_t g = 0; g < groups; ++g) m.first[g + 1] += m.first[g];
  m.item.resize(m.first[groups]);
  std::vector<std::uint32_t> next(m.first.begin(), m.first.end() - 1);
  for (std::uint32_t i = 0; i < group_of.size(); ++i)
    if (group_of[i] != scene::kNone) m.item[next[group_of[i]]++] = i;
  return m;
}

}  // namespace relume::transport
