// SPDX-License-Identifier: MIT
#include "light_hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace relume::transport {
namespace {

float angleOf(float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)); }

/// v turned by `angle` about the unit `axis` (Rodrigues).
Vec3 turned(Vec3 v, Vec3 axis, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return c * v + s * glm::cross(axis, v) + (1.0f - c) * glm::dot(axis, v) * axis;
}

struct Cone {
  Direction axis;
  float cosine;
};

Cone merged(Cone a, Cone b) {
  if (a.cosine > b.cosine) std::swap(a, b);
  const float spread_a = angleOf(a.cosine), spread_b = angleOf(b.cosine);
  const float apart = angleOf(glm::dot(a.axis, b.axis));
  if (std::min(apart + spread_b, kPi) <= spread_a) return a;
  const float spread = 0.5f * (spread_a + apart + spread_b);
  const Vec3 about = glm::cross(a.axis, b.axis);
  const float length = glm::length(about);
  if (spread >= kPi || !(length > 1e-6f)) return {a.axis, -1.0f};
  return {glm::normalize(turned(a.axis, about / length, spread - spread_a)), std::cos(spread)};
}

constexpr int kBuckets = 12;

/// Along which axis and before which bucket the cost of the two halves is least; axis -1: nowhere.
struct Split {
  int axis = -1, bucket = 0;
  float cost = kInfinity;
};

int bucketOf(const Box3& centres, int axis, Point centre) {
  const float t = (centre[axis] - centres.lo[axis]) / (centres.hi[axis] - centres.lo[axis]);
  return std::clamp(static_cast<int>(t * kBuckets), 0, kBuckets - 1);
}

struct Entry {
  EmitterBounds bounds;
  std::uint32_t emitter;
};

struct Builder {
  std::vector<LightGroup> nodes;
  std::uint32_t build(std::span<Entry> entries);
};

}  // namespace

float costOf(const EmitterBounds& b) {
  const float spread = angleOf(b.cos_spread), reach = std::min(spread + angleOf(b.cos_emission), kPi);
  const float sine = std::sin(spread), cosine = std::cos(spread);
  const float directions =
      2 * kPi * (1 - cosine) +
      0.5f * kPi * (2 * reach * sine - std::cos(spread - 2 * reach) - 2 * spread * sine + cosine);
  const Vec3 e = b.box.extent();
  return b.intensity * directions * (e.x * e.y + e.y * e.z + e.z * e.x);
}

EmitterBounds merged(const EmitterBounds& a, const EmitterBounds& b) {
  EmitterBounds both = a;
  both.box.add(b.box);
  const Cone cone = merged(Cone{a.axis, a.cos_spread}, Cone{b.axis, b.cos_spread});
  both.axis = cone.axis, both.cos_spread = cone.cosine;
  both.cos_emission = std::min(a.cos_emission, b.cos_emission);
  both.two_sided = a.two_sided || b.two_sided;
  both.intensity = a.intensity + b.intensity;
  return both;
}

namespace {

std::uint32_t Builder::build(std::span<Entry> entries) {
  const auto index = static_cast<std::uint32_t>(nodes.size());
  nodes.emplace_back();
  if (entries.size() == 1) {
    nodes[index].bounds = entries[0].bounds, nodes[index].emitter = entries[0].emitter;
    return index;
  }
  Box3 centres, whole;
  for (const Entry& e : entries) centres.add(e.bounds.box.centre()), whole.add(e.bounds.box);
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(centres.hi[axis] > centres.lo[axis])) continue;
    std::array<std::optional<EmitterBounds>, kBuckets> buckets;
    for (const Entry& e : entries) {
      auto& bucket = buckets[static_cast<std::size_t>(bucketOf(centres, axis, e.bounds.box.centre()))];
      bucket = bucket ? merged(*bucket, e.bounds) : e.bounds;
    }
    std::array<float, kBuckets> below{}, above{};
    std::optional<EmitterBounds> sum;
    const auto add = [&](std::size_t b) {
      if (buckets[b]) sum = sum ? merged(*sum, *buckets[b]) : *buckets[b];
      return sum ? costOf(*sum) : 0.0f;
    };
    for (std::size_t b = 0; b < kBuckets; ++b) below[b] = add(b);
    sum.reset();
    for (std::size_t b = kBuckets; b-- > 0;) above[b] = add(b);
    // Long thin bounds are cut across ([CK18] K_r).
    const Vec3 e = whole.extent();
    const float regular = std::max({e.x, e.y, e.z}) / e[axis];
    for (std::size_t b = 1; b < kBuckets; ++b)
      if (const float cost = regular * (below[b - 1] + above[b]); cost < best.cost)
        best = {axis, static_cast<int>(b), cost};
  }
  auto middle = entries.begin();
  if (best.axis >= 0)
    middle = std::partition(entries.begin(), entries.end(), [&](const Entry& e) {
      return bucketOf(centres, best.axis, e.bounds.box.centre()) < best.bucket;
    });
  if (middle == entries.begin() || middle == entries.end())
    middle = entries.begin() + static_cast<std::ptrdiff_t>(entries.size() / 2);
  const auto first = static_cast<std::size_t>(middle - entries.begin());
  build(entries.first(first));
  const std::uint32_t second = build(entries.subspan(first));
  nodes[index].second = second;
  nodes[index].bounds = merged(nodes[index + 1].bounds, nodes[second].bounds);
  return index;
}

}  // namespace

std::vector<LightGroup> lightHierarchy(std::span<const EmitterBounds> emitters) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < emitters.size(); ++i)
    if (emitters[i].intensity > 0) entries.push_back({emitters[i], static_cast<std::uint32_t>(i)});
  Builder builder;
  builder.nodes.reserve(2 * entries.size());
  if (!entries.empty()) builder.build(entries);
  return std::move(builder.nodes);
}

}  // namespace relume::transport
