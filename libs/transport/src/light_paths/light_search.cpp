// SPDX-License-Identifier: MIT
#include "relume/transport/light_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/core/parallel.h"
#include "relume/core/sampling.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kViews = 512;      // rays all around a place
constexpr std::uint32_t kFewViews = 64;    // to begin with
constexpr std::uint32_t kMostTries = 512;  // for each light
constexpr std::uint32_t kRound = 256;      // tries at once
constexpr std::uint32_t kPilot = 2048;     // tries that tell whether there are rooms
// Of the rays that meet the front of something: in the open, above a ground; in a room with windows.
constexpr float kOpen = 0.4f, kEnclosed = 0.8f;
constexpr float kRooms = 1.0f / 256;                 // of the tries, where there are rooms
constexpr float kNarrowest = 0.35f, kWidest = 1.0f;  // radians, cones of spot lights

struct Sight {
  float fronts = 0, backs = 0;  // shares of rays
  float nearest = kInfinity;    // metres
};

Sight lookAround(const trace::Tracer& tracer, Point from, std::uint32_t views) {
  Sight sight;
  const float share = 1.0f / static_cast<float>(views);
  for (std::uint32_t i = 0; i < views; ++i) {
    const trace::RayHit hit = tracer.intersect({from, squareToSphere(sobol2(i, 0)), kInfinity}, i);
    if (!hit) continue;
    (hit.back_face ? sight.backs : sight.fronts) += share;
    sight.nearest = std::min(sight.nearest, hit.t);
  }
  return sight;
}
bool isFree(const Sight& sight, float least) {
  return sight.fronts >= least && sight.backs <= kBuriedShare * sight.fronts;
}

/// A point of the boxes, each as often as it is large.
Point inBoxes(std::span<const Box3> boxes, Vec2 u, Vec2 v) {
  float all = 0;
  const auto volume = [](const Box3& b) { return b.extent().x * b.extent().y * b.extent().z; };
  for (const Box3& b : boxes) all += volume(b);
  float left = v.y * all;
  std::size_t i = 0;
  while (i + 1 < boxes.size() && left >= volume(boxes[i])) left -= volume(boxes[i++]);
  return boxes[i].lo + boxes[i].extent() * Vec3(u.x, u.y, v.x);
}

/// Of what a place sees: where there are rooms, lights are in them; otherwise they may be in the open.
float leastSeen(const trace::Tracer& tracer, std::span<const Box3> boxes, std::uint32_t stream) {
  std::vector<std::uint8_t> room(kPilot);
  parallelFor(kPilot, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto index = static_cast<std::uint32_t>(i);
      const Point at = inBoxes(boxes, sobol2(index, stream), sobol2(index, hashCombine(stream, 1)));
      room[i] = isFree(lookAround(tracer, at, kFewViews), kEnclosed);
    }
  });
  const auto rooms = static_cast<float>(std::count(room.begin(), room.end(), 1));
  return rooms >= kRooms * static_cast<float>(kPilot) ? kEnclosed : kOpen;
}

}  // namespace

LightSet findLights(const trace::Tracer& tracer, std::span<const Box3> boxes, std::uint32_t count,
                    const LightPlaces& places, std::uint64_t seed, Progress& progress) {
  LightSet lights;
  const std::uint32_t stream = streamOf(seed, 0, 0);
  const float least = leastSeen(tracer, boxes, stream);
  for (std::uint32_t first = 0; lights.size() < count && first < count * kMostTries; first += kRound) {
    progress.throwIfCancelled();
    std::array<Point, kRound> at;
    std::array<std::uint8_t, kRound> fits{};
    for (std::uint32_t i = 0; i < kRound; ++i)
      at[i] = inBoxes(boxes, sobol2(first + i, stream), sobol2(first + i, hashCombine(stream, 1)));
    parallelFor(kRound, 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!isFree(lookAround(tracer, at[i], kFewViews), 0.75f * least)) continue;
        const Sight s = lookAround(tracer, at[i], kViews);
        fits[i] = isFree(s, least) && s.nearest >= places.nearest && s.nearest <= places.farthest;
      }
    });
    for (std::uint32_t i = 0; i < kRound && lights.size() < count; ++i) {
      if (!fits[i]) continue;
      const auto number = static_cast<std::uint32_t>(lights.size());
      Light& light = lights.emplace_back();
      light.position = at[i];
      const Vec2 u = sobol2(number, hashCombine(stream, 2)), v = sobol2(number, hashCombine(stream, 3));
      if (v.x >= places.spots) continue;
      light.kind = Light::Kind::kSpot;
      light.direction = squareToSphere(u);
      light.outer_cone = kNarrowest + v.y * (kWidest - kNarrowest);
      light.inner_cone = 0.5f * light.outer_cone;
    }
  }
  return lights;
}

}  // namespace relume::transport
