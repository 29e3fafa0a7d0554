// SPDX-License-Identifier: MIT
// Choosing a viewpoint by a few thousand rays.
//
// Interiors: the box is filled with a grid of places. A place is indoors when rays from it in all directions
// mostly hit something, and by its front, and it stands over a level floor. When enough places are indoors
// the scene is an interior. Directions in which the indoor rays leave the scene tell an open side, from which
// the whole is then seen. Otherwise each indoor place, lifted to the middle between floor and ceiling, looks
// around; the view that sees front faces farthest away wins, and what is close before the eye counts against
// it. That prefers corners that look across the room. Outside: the eye goes where the frustum's planes touch
// the vertices, found in closed form for each axis of the picture. Limits: one room of a house with many
// rooms is shown, not the house.
#include "framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "relume/core/parallel.h"
#include "relume/core/sampling.h"

namespace relume::picture {
namespace {

constexpr float kOutsideFov = 0.6f;  // radians
constexpr float kInsideFov = 1.0f;   // radians; wide, as interiors are photographed
constexpr float kDegree = kPi / 180.0f;
constexpr float kElevation = 25.0f * kDegree, kDollsHouseElevation = 55.0f * kDegree;
constexpr float kAzimuth = 35.0f * kDegree;  // from +z towards +x
constexpr float kDownward = 5.0f * kDegree;  // inside
constexpr float kMargin = 0.94f;             // of the picture that the scene may fill

constexpr int kPlan = 9, kStoreys = 3;    // places along the box, across and up
constexpr std::uint32_t kProbeRays = 48;  // from each place
constexpr float kIndoorHits =
    0.75f;  // share of its rays that hit, e.g. 5/6 in the middle of a box with an open side
constexpr float kIndoorBacks = 0.1f;    // share that may hit from behind
constexpr float kLevel = 0.9f;          // cosine of a floor's slope; not so in most of a hollow sphere
constexpr float kInteriorShare = 0.3f;  // of all places that are indoors
constexpr float kOpenShare = 0.06f;     // of indoor rays that miss where a side is open; windows miss less
constexpr float kOpenFocus = 0.7f;      // length of the mean direction of those rays
constexpr int kAzimuths = 16;
constexpr int kViewColumns = 9, kViewRows = 5;

/// Where rays from a place in all directions go.
struct Probe {
  int hits = 0, backs = 0;
  Vec3 open{0.0f};  ///< sum of the directions that hit nothing
};

Probe probe(const trace::Tracer& tracer, Point p) {
  Probe result;
  for (std::uint32_t i = 0; i < kProbeRays; ++i) {
    const Direction d = squareToSphere(sobol2(i, 0));
    const trace::RayHit hit = tracer.intersect({p, d});
    if (!hit) result.open += d;
    result.hits += hit ? 1 : 0;
    result.backs += hit.back_face ? 1 : 0;
  }
  return result;
}

bool isIndoors(const trace::Tracer& tracer, Point p, const Probe& around) {
  if (static_cast<float>(around.hits) < kIndoorHits * kProbeRays) return false;
  if (static_cast<float>(around.backs) > kIndoorBacks * kProbeRays) return false;
  const trace::RayHit floor = tracer.intersect({p, {0, -1, 0}});
  return floor &&
         std::abs(scene::geometricNormal(tracer.scene(), floor.where.instance, floor.where.triangle).y) >
             kLevel;
}

struct Eye {
  Point position{0.0f};
  float headroom = 0;  ///< metres from floor to ceiling
  bool usable = false;
};

/// The middle between floor and ceiling above and below p.
Eye standAt(const trace::Tracer& tracer, Point p) {
  const trace::RayHit down = tracer.intersect({p, {0, -1, 0}}), up = tracer.intersect({p, {0, 1, 0}});
  if (!down || !up) return {};
  return {p + Vec3(0, 0.5f * (up.t - down.t), 0), up.t + down.t, true};
}

/// Calls visit(ray direction) for a grid of directions in the picture.
template <class Visit>
void forView(const Viewpoint& view, float aspect, const Visit& visit) {
  const float half = std::tan(0.5f * view.vertical_fov);
  const Mat3 axes(view.world_from_camera);
  for (int row = 0; row < kViewRows; ++row)
    for (int column = 0; column < kViewColumns; ++column) {
      const float x = 2.0f * (static_cast<float>(column) + 0.5f) / kViewColumns - 1.0f;
      const float y = 2.0f * (static_cast<float>(row) + 0.5f) / kViewRows - 1.0f;
      visit(glm::normalize(axes * Vec3(x * half * aspect, y * half, -1.0f)));
    }
}

/// How much a view from inside shows, in [-1, 1].
float insideScore(const trace::Tracer& tracer, const Viewpoint& view, float aspect, float headroom,
                  float longest) {
  float score = 0;
  const Point eye = view.world_from_camera[3];
  forView(view, aspect, [&](Direction d) {
    const trace::RayHit hit = tracer.intersect({eye, d});
    if (!hit || hit.back_face) return;
    // The root: one deep corridor must not outweigh a whole room. Things before one's nose hide it.
    score += hit.t < 0.3f * headroom ? -1.0f : std::sqrt(std::min(hit.t / longest, 1.0f));
  });
  return score / (kViewColumns * kViewRows);
}

/// Downwards at `elevation` above the horizon, from `azimuth`.
Direction slanted(float azimuth, float elevation) {
  return {-std::sin(azimuth) * std::cos(elevation), -std::sin(elevation),
          -std::cos(azimuth) * std::cos(elevation)};
}

/// Calls visit(world position) for the vertices to frame: of static instances, or of all when none is static.
template <class Visit>
void forVertices(const scene::Scene& scene, const Visit& visit) {
  const bool any_static = std::any_of(scene.instances.begin(), scene.instances.end(),
                                      [](const scene::Instance& i) { return !i.dynamic; });
  for (const scene::Instance& instance : scene.instances) {
    if (instance.dynamic && any_static) continue;
    for (const Point& p : scene.meshes[instance.mesh].positions)
      visit(Point(instance.world_from_local * Vec4(p, 1)));
  }
}

}  // namespace

Box3 boundsToFrame(const scene::Scene& scene) {
  Box3 box = scene.bounds();
  if (box.empty()) forVertices(scene, [&](Point p) { box.add(p); });
  if (box.empty()) box.add(Point(0));
  return box;
}

Viewpoint fit(const scene::Scene& scene, const Box3& box, Direction forward, float aspect) {
  const float scale = std::max(box.diagonal(), 1e-6f * glm::length(box.centre()) + 1e-6f);
  Viewpoint view = lookAt(Point(0), forward, kOutsideFov);
  const Mat3 axes(view.world_from_camera);
  const Vec2 tangent = kMargin * std::tan(0.5f * kOutsideFov) * Vec2(aspect, 1.0f);
  // A point at (x, y) in the picture's axes and depth z lies inside when |x - eye_x| <= tangent (z - eye_z),
  // for y alike.
  Vec2 right{-kInfinity}, left{-kInfinity};
  forVertices(scene, [&](Point p) {
    const Vec3 c = p - box.centre();
    const Vec2 x = {glm::dot(axes[0], c), glm::dot(axes[1], c)};
    const float z = glm::dot(forward, c);
    right = glm::max(right, x / tangent - z);
    left = glm::max(left, -x / tangent - z);
  });
  if (!(right.x > -kInfinity)) right = left = Vec2(0);
  const Vec2 aside = 0.5f * tangent * (right - left);
  const Vec2 back = 0.5f * (right + left);
  // Never among the vertices of a flat scene.
  const float distance = std::max({back.x, back.y, 0.6f * scale});
  const Point eye = box.centre() + aside.x * axes[0] + aside.y * axes[1] - distance * forward;
  view.world_from_camera[3] = Vec4(eye, 1);
  return view;
}

Viewpoint frameFromOutside(const trace::Tracer& tracer, const Box3& box, float aspect) {
  Viewpoint best;
  float best_score = -kInfinity;
  for (int quarter = 0; quarter < 4; ++quarter) {
    // Right front, left front, right back, left back.
    const float azimuth = (quarter & 1 ? -1.0f : 1.0f) * (quarter & 2 ? kPi - kAzimuth : kAzimuth);
    const Viewpoint view = fit(tracer.scene(), box, slanted(azimuth, kElevation), aspect);
    float score = 0;
    forView(view, aspect, [&](Direction d) {
      if (const trace::RayHit hit = tracer.intersect({Point(view.world_from_camera[3]), d}))
        score += hit.back_face ? -2.0f : 1.0f;
    });
    // A later quarter must show clearly more.
    if (score > best_score + (quarter ? 0.05f * kViewColumns * kViewRows : 0.0f))
      best = view, best_score = score;
  }
  return best;
}

std::optional<Viewpoint> frameInterior(const trace::Tracer& tracer, const Box3& box, float aspect) {
  constexpr std::size_t kPlaces = kPlan * kPlan * kStoreys;
  struct Candidate {
    bool indoors = false;
    Probe around;
    float score = -kInfinity;
    Viewpoint view;
  };
  std::vector<Candidate> candidates(kPlaces);
  const float longest = std::max(box.diagonal(), 1e-20f);
  parallelFor(kPlaces, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 cell = {static_cast<float>(i % kPlan) + 0.5f, static_cast<float>(i / (kPlan * kPlan)) + 0.5f,
                         static_cast<float>(i / kPlan % kPlan) + 0.5f};
      const Point p = box.lo + box.extent() * cell / Vec3(kPlan, kStoreys, kPlan);
      Candidate& candidate = candidates[i];
      candidate.around = probe(tracer, p);
      candidate.indoors = isIndoors(tracer, p, candidate.around);
      if (!candidate.indoors) continue;
      const Eye eye = standAt(tracer, p);
      if (!eye.usable || !isIndoors(tracer, eye.position, probe(tracer, eye.position))) continue;
      for (int a = 0; a < kAzimuths; ++a) {
        const float azimuth = (static_cast<float>(a) + 0.5f) * 2.0f * kPi / kAzimuths;
        const Viewpoint view = lookAt(eye.position, eye.position + slanted(azimuth, kDownward), kInsideFov);
        const float score = insideScore(tracer, view, aspect, eye.headroom, longest);
        if (score > candidate.score) candidate.score = score, candidate.view = view;
      }
    }
  });

  int indoors = 0, misses = 0;
  Vec3 open(0.0f);
  const Candidate* best = nullptr;
  for (const Candidate& candidate : candidates) {
    if (!candidate.indoors) continue;
    ++indoors;
    misses += static_cast<int>(kProbeRays) - candidate.around.hits;
    open += candidate.around.open;
    if (candidate.score > (best ? best->score : 0.0f)) best = &candidate;
  }
  if (static_cast<float>(indoors) < kInteriorShare * kPlaces) return std::nullopt;
  const float focus = glm::length(open) / static_cast<float>(std::max(misses, 1));
  if (static_cast<float>(misses) > kOpenShare * kProbeRays * static_cast<float>(indoors) &&
      focus > kOpenFocus) {
    const Direction side = glm::normalize(open);
    // A room with a skylight still has places under its ceiling.
    if (side.y > 0.7f && !best)
      return fit(tracer.scene(), box, slanted(kAzimuth, kDollsHouseElevation), aspect);
    // A stage is seen straight; the few degrees by which the rays miss its axis are chance.
    const int axis = std::abs(side.x) > std::abs(side.z) ? 0 : 2;
    if (std::abs(side[axis]) > 0.9f) {
      Direction forward(0.0f);
      forward[axis] = side[axis] > 0 ? -1.0f : 1.0f;
      return fit(tracer.scene(), box, forward, aspect);
    }
  }
  if (!best) return std::nullopt;
  return best->view;
}

}  // namespace relume::picture
