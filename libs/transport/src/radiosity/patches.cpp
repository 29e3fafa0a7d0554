// SPDX-License-Identifier: MIT
#include "radiosity/patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "relume/core/check.h"
#include "texel_groups.h"

namespace relume::transport {
namespace {

constexpr float kTurnCosine = 0.7071f;  // 45 degrees
constexpr float kFlatCosine = 0.9999f;

struct Place {
  std::uint32_t page, x, y;
};
Place placeOf(const atlas::Texels& texels, std::uint32_t point) {
  const auto width = static_cast<std::uint32_t>(texels.width),
             height = static_cast<std::uint32_t>(texels.height);
  const std::uint32_t texel = texels.points[point].texel, row = texel / width;
  return {row / height, texel % width, row % height};
}

/// Blocks of a chart, then 4 x 4 blocks of texels, then texels.
auto orderOf(const atlas::Texels& texels, std::uint32_t side, std::uint32_t point) {
  const Place p = placeOf(texels, point);
  return std::tuple(p.page, p.y / side, p.x / side, texels.points[point].chart, p.y / kGroupSide,
                    p.x / kGroupSide, point);
}

/// Area, normal and middle, from the members.
void measure(const atlas::Texels& texels, std::span<const std::uint32_t> members, std::uint32_t full,
             Patch& patch) {
  Vec3 middle(0.0f), normal(0.0f), geometric(0.0f);
  float area = 0;
  for (const std::uint32_t i : members) {
    const atlas::SurfacePoint& p = texels.points[i];
    area += p.area, middle += p.area * p.position;
    normal += p.area * p.shading_normal, geometric += p.area * p.geometric_normal;
  }
  const atlas::SurfacePoint& first = texels.points[members[0]];
  const auto unit = [](Vec3 v, Normal otherwise) {
    const float length = glm::length(v);
    return length > 0 ? v / length : otherwise;
  };
  patch.area = area;
  patch.normal = unit(normal, first.shading_normal);
  patch.geometric_normal = unit(geometric, first.geometric_normal);
  middle = area > 0 ? middle / area : first.position;
  const bool flat =
      members.size() == full && std::all_of(members.begin(), members.end(), [&](auto i) {
        return glm::dot(texels.points[i].geometric_normal, patch.geometric_normal) > kFlatCosine;
      });
  if (flat) {
    patch.centre = middle;
    return;
  }
  // The mean of a curved or a cut block need not lie on the surface.
  const std::uint32_t nearest =
      *std::min_element(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
        return glm::length(texels.points[a].position - middle) <
               glm::length(texels.points[b].position - middle);
      });
  patch.centre = texels.points[nearest].position;
  patch.normal = texels.points[nearest].shading_normal;
  patch.geometric_normal = texels.points[nearest].geometric_normal;
}

}  // namespace

Patches makePatches(const atlas::Texels& texels, std::uint32_t side, std::span<const std::uint8_t> buried) {
  RELUME_CHECK(side > 0);
  RELUME_CHECK_EQ(buried.size(), texels.points.size());
  Patches patches;
  patches.side = side;
  patches.patch_of.resize(texels.points.size());
  std::vector<std::uint32_t> order(texels.points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return orderOf(texels, side, a) < orderOf(texels, side, b);
  });
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    const Place p = placeOf(texels, a), q = placeOf(texels, b);
    return p.page == q.page && p.y / side == q.y / side && p.x / side == q.x / side &&
           texels.points[a].chart == texels.points[b].chart;
  };
  std::vector<std::vector<std::uint32_t>> parts;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    parts.clear();
    for (end = begin; end < order.size() && same(order[begin], order[end]); ++end) {
      const Normal n = texels.points[order[end]].geometric_normal;
      const auto fits = std::find_if(parts.begin(), parts.end(), [&](const auto& part) {
        return glm::dot(texels.points[part[0]].geometric_normal, n) > kTurnCosine;
      });
      (fits == parts.end() ? parts.emplace_back() : *fits).push_back(order[end]);
    }
    for (const auto& part : parts) {
      const Place place = placeOf(texels, part[0]);
      Patch patch;
      patch.first = static_cast<std::uint32_t>(patches.members.size());
      patch.chart = texels.points[part[0]].chart, patch.page = place.page;
      patch.x = place.x / side, patch.y = place.y / side;
      for (const std::uint32_t i : part) {
        patches.patch_of[i] = static_cast<std::uint32_t>(patches.all.size());
        if (!buried[i]) patches.members.push_back(i);
      }
      if (patches.members.size() == patch.first)
        patches.members.insert(patches.members.end(), part.begin(), part.end());
      patch.count = static_cast<std::uint32_t>(patches.members.size()) - patch.first;
      measure(texels, std::span(patches.members).subspan(patch.first, patch.count), side * side, patch);
      patches.all.push_back(patch);
    }
  }
  return patches;
}

void Patches::forEachGroup(const atlas::Texels& texels, std::size_t patch,
                           const std::function<void(std::span<const std::uint32_t>)>& visit) const {
  const std::span<const std::uint32_t> own = membersOf(patch);
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    const Place p = placeOf(texels, a), q = placeOf(texels, b);
    return p.y / kGroupSide == q.y / kGroupSide && p.x / kGroupSide == q.x / kGroupSide;
  };
  for (std::size_t begin = 0, end = 0; begin < own.size(); begin = end) {
    for (end = begin + 1; end < own.size() && same(own[begin], own[end]);) ++end;
    visit(own.subspan(begin, end - begin));
  }
}

std::vector<Vec3> Patches::means(const atlas::Texels& texels, std::span<const Vec3> values) const {
  std::vector<Vec3> result(size(), Vec3(0.0f));
  for (std::size_t i = 0; i < size(); ++i) {
    float area = 0;
    for (const std::uint32_t point : membersOf(i))
      result[i] += texels.points[point].area * values[point], area += texels.points[point].area;
    if (area > 0) result[i] /= area;
  }
  return result;
}

Parents parentsOf(const Patches& patches) {
  const auto key = [&](std::uint32_t i) {
    const Patch& p = patches.all[i];
    return std::tuple(p.page, p.y / 2, p.x / 2, p.chart);
  };
  std::vector<std::uint32_t> order(patches.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
  Parents parents;
  parents.of.resize(patches.size());
  std::vector<std::pair<Normal, std::uint32_t>> parts;  // of a block: normal and number
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || key(order[k]) != key(order[k - 1])) parts.clear();
    const Patch& patch = patches.all[order[k]];
    auto fits = std::find_if(parts.begin(), parts.end(), [&](const auto& part) {
      return glm::dot(part.first, patch.geometric_normal) > kTurnCosine;
    });
    if (fits == parts.end()) {
      parts.emplace_back(patch.geometric_normal, static_cast<std::uint32_t>(parents.area.size()));
      parents.area.push_back(0.0f);
      fits = std::prev(parts.end());
    }
    parents.of[order[k]] = fits->second;
    parents.area[fits->second] += patch.area;
  }
  return parents;
}

std::vector<Vec3> Parents::means(const Patches& patches, std::span<const Vec3> values) const {
  std::vector<Vec3> result(area.size(), Vec3(0.0f));
  for (std::size_t i = 0; i < patches.size(); ++i)
    if (area[of[i]] > 0) result[of[i]] += patches.all[i].area / area[of[i]] * values[i];
  return result;
}

}  // namespace relume::transport
