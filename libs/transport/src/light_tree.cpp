// SPDX-License-Identifier: MIT
#include "light_tree.h"

#include <algorithm>
#include <cmath>

#include "light_hierarchy.h"

namespace relume::transport {
namespace {

float sineOf(float cosine) { return std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)); }

/// cos(max(0, a - b)) of two angles in [0, pi] given by their cosines.
float cosOfDifference(float cos_a, float cos_b) {
  return cos_a > cos_b ? 1.0f : cos_a * cos_b + sineOf(cos_a) * sineOf(cos_b);
}

// How much the size of a group adds to its squared distance, in units of its squared radius. Of 10 to 10,000
// lamps over a floor this made the error the same, 1.4 to 1.6 % at 256 samples; where the radius bounds the
// distance instead (weight 1), a thousand lamps made 3.5 times the error of ten.
constexpr float kSpread = 0.15f;
constexpr float kNoDistance = 1e-12f;  // m^2, so that nothing is divided by 0

}  // namespace

float EmitterBounds::importance(Point p, Normal n) const {
  const Vec3 way = p - box.centre();
  const float distance2 = glm::dot(way, way);
  const float radius2 = 0.25f * glm::dot(box.extent(), box.extent());
  // The angle that the bounds' sphere subtends; all around from inside of it.
  const float cos_extent = distance2 > radius2 ? std::sqrt(1.0f - radius2 / distance2) : -1.0f;
  const Direction d = distance2 > 0 ? way / std::sqrt(distance2) : axis;
  float cos_axis = glm::dot(axis, d);
  if (two_sided) cos_axis = std::abs(cos_axis);
  const float cos_leaving = cosOfDifference(cosOfDifference(cos_axis, cos_spread), cos_extent);
  if (cos_leaving <= cos_emission) return 0.0f;
  const float cos_arriving = n == Normal(0) ? 1.0f : cosOfDifference(-glm::dot(n, d), cos_extent);
  return std::max(intensity * cos_leaving * cos_arriving / (distance2 + kSpread * radius2 + kNoDistance),
                  0.0f);
}

void LightTree::Node::set(std::size_t lane, const EmitterBounds& b, std::uint32_t the_child) {
  const Point centre = b.box.centre();
  const Vec3 extent = b.box.extent();
  cx[lane] = centre.x, cy[lane] = centre.y, cz[lane] = centre.z;
  radius2[lane] = 0.25f * glm::dot(extent, extent);
  ax[lane] = b.axis.x, ay[lane] = b.axis.y, az[lane] = b.axis.z;
  cos_spread[lane] = b.cos_spread, sin_spread[lane] = sineOf(b.cos_spread);
  cos_emission[lane] = b.cos_emission, intensity[lane] = b.intensity;
  two_sided[lane] = b.two_sided ? ~0u : 0u;
  child[lane] = the_child;
}

void LightTree::Node::importances(Point p, Normal n, float* result) const {
  const float all_around = n == Normal(0) ? 1.0f : 0.0f;
  for (std::size_t i = 0; i < kWidth; ++i) {
    const float wx = p.x - cx[i], wy = p.y - cy[i], wz = p.z - cz[i];
    const float distance2 = wx * wx + wy * wy + wz * wz;
    const float inverse = 1.0f / std::sqrt(std::max(distance2, 1e-30f));
    const float inside = distance2 > radius2[i] ? 0.0f : 1.0f;
    const float ratio = std::min(radius2[i] / std::max(distance2, 1e-30f), 1.0f);
    const float cos_extent = std::sqrt(1.0f - ratio) - inside,
                sin_extent = inside > 0 ? 0.0f : std::sqrt(ratio);
    float cos_axis = distance2 > 0 ? (ax[i] * wx + ay[i] * wy + az[i] * wz) * inverse : 1.0f;
    cos_axis = two_sided[i] ? std::abs(cos_axis) : cos_axis;
    const float sin_axis = std::sqrt(std::max(0.0f, 1.0f - cos_axis * cos_axis));
    const float turned =
        cos_axis > cos_spread[i] ? 1.0f : cos_axis * cos_spread[i] + sin_axis * sin_spread[i];
    const float sin_turned = std::sqrt(std::max(0.0f, 1.0f - turned * turned));
    const float leaving = turned > cos_extent ? 1.0f : turned * cos_extent + sin_turned * sin_extent;
    const float towards = -(n.x * wx + n.y * wy + n.z * wz) * inverse;
    const float sin_towards = std::sqrt(std::max(0.0f, 1.0f - towards * towards));
    const float above = towards > cos_extent ? 1.0f : towards * cos_extent + sin_towards * sin_extent;
    const float arriving = all_around > 0 ? 1.0f : above;
    const float value = intensity[i] * leaving * arriving / (distance2 + kSpread * radius2[i] + kNoDistance);
    result[i] = leaving > cos_emission[i] ? std::max(value, 0.0f) : 0.0f;
  }
}

LightTree::LightTree(std::span<const EmitterBounds> emitters) : leaf_of_(emitters.size()) {
  const std::vector<LightGroup> groups = lightHierarchy(emitters);
  if (groups.empty()) return;
  // Groups are opened, the costliest first, until a node is full.
  struct Open {
    std::uint32_t group, parent, slot;
  };
  std::vector<Open> waiting{{0, kNoNode, 0}};
  for (std::size_t next = 0; next < waiting.size(); ++next) {
    const Open open = waiting[next];
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    if (open.parent != kNoNode) nodes_[open.parent].child[open.slot] = index;
    std::vector<std::uint32_t> members{open.group};
    while (members.size() < kWidth) {
      auto widest = members.end();
      float cost = -1.0f;
      for (auto m = members.begin(); m != members.end(); ++m)
        if (groups[*m].second != LightGroup::kNone && costOf(groups[*m].bounds) > cost)
          widest = m, cost = costOf(groups[*m].bounds);
      if (widest == members.end()) break;
      const std::uint32_t group = *widest;
      *widest = group + 1;
      members.push_back(groups[group].second);
    }
    Node& node = nodes_.emplace_back();
    node.parent = open.parent, node.slot = open.slot;
    for (std::uint32_t slot = 0; slot < members.size(); ++slot) {
      const LightGroup& group = groups[members[slot]];
      const bool leaf = group.second == LightGroup::kNone;
      node.set(slot, group.bounds, leaf ? group.emitter | kLeafBit : 0);
      if (leaf) {
        leaf_of_[group.emitter] = {index, slot};
      } else {
        waiting.push_back({members[slot], index, slot});
      }
    }
  }
}

LightTree::Choice LightTree::choose(Point p, Normal n, float u) const {
  if (empty()) return {};
  float probability = 1.0f;
  for (std::uint32_t at = 0;;) {
    const Node& node = nodes_[at];
    alignas(32) float own[kWidth];
    node.importances(p, n, own);
    float sum = 0;
    for (const float i : own) sum += i;
    if (!(sum > 0)) return {};
    // The last one that is not dark takes what rounding leaves over.
    float below = 0;
    std::size_t chosen = 0;
    float start = 0;
    for (std::size_t i = 0; i < kWidth; ++i) {
      if (!(own[i] > 0)) continue;
      chosen = i, start = below;
      below += own[i];
      if (u * sum < below) break;
    }
    probability *= own[chosen] / sum;
    u = std::clamp((u * sum - start) / own[chosen], 0.0f, 0x1.fffffep-1f);
    if ((node.child[chosen] & kLeafBit) != 0) return {node.child[chosen] & ~kLeafBit, probability};
    at = node.child[chosen];
  }
}

float LightTree::probability(Point p, Normal n, std::uint32_t emitter) const {
  Leaf at = leaf_of_[emitter];
  float probability = 1.0f;
  while (at.node != kNoNode) {
    const Node& node = nodes_[at.node];
    alignas(32) float own[kWidth];
    node.importances(p, n, own);
    float sum = 0;
    for (const float i : own) sum += i;
    if (!(own[at.slot] > 0)) return 0.0f;
    probability *= own[at.slot] / sum;
    at = {node.parent, node.slot};
  }
  return leaf_of_[emitter].node == kNoNode ? 0.0f : probability;
}

}  // namespace relume::transport
