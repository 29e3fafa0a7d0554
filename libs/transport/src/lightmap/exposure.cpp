// SPDX-License-Identifier: MIT
// Up to 16 places of a footprint are looked at. What opaque surfaces lie close upon (kGap) nobody sees. The
// others are lifted off the surface, as far as there is room, and those that see each other, directly or from
// one to the next, are together. A part of which many rays meet backs of faces lies inside a body. Of the
// parts that are left the largest is the texel; where the chart folds inside the texel, the largest on each
// of its faces. Where nothing stands it costs two packets of short rays
// for a block of 4 x 4 texels. Limits: what is thinner
// than the places are apart may stand in a texel unseen; a texel with parts that are equally large, on the
// two sides of a wall, is right for one side only.
#include "lightmap/exposure.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "relume/core/frame.h"
#include "relume/core/parallel.h"
#include "relume/core/sampling.h"
#include "relume/transport/occlusion.h"
#include "texel_groups.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kSide = 4, kMost = kSide * kSide;
static_assert(kMost == trace::RayPacket::kSize);
constexpr float kLift = 0.25f;        // texels: lower things do not part a texel
constexpr float kGap = 1.0f / 16;     // texels: what has less room above it is covered
constexpr float kFoldCosine = 0.97f;  // faces that look different ways do not see each other, rightly
constexpr float kShort = 0.999f;      // of the way between places, so that it ends before a surface there
constexpr std::uint32_t kBuriedRays = kMost;
constexpr float kMuchDarker = 0.25f;

using Mask = std::uint32_t;  // bit i: place i

/// Metres.
float texelSize(const atlas::SurfacePoint& p) { return std::sqrt(glm::length(glm::cross(p.dp_dx, p.dp_dy))); }

class TexelParts {
 public:
  TexelParts(const trace::Tracer& tracer, const atlas::Texels& texels) : tracer_(tracer), texels_(texels) {
    const scene::Scene& scene = tracer.scene();
    for (const scene::Instance& instance : scene.instances) {
      const scene::Material& m = scene.materials[scene.meshes[instance.mesh].material];
      opaque_.push_back(m.alpha_mode == scene::AlphaMode::kOpaque && !(m.transmission > 0));
    }
  }

  Mask all() const { return count_ == 32 ? ~0u : (1u << count_) - 1; }
  const atlas::SubSample& place(std::uint32_t i) const { return places_[i]; }
  /// What `exposed` found to be as open, but on another side of something.
  Mask far() const { return far_; }

  /// Nothing stands among these neighbours, as far as rays along their rows, columns and normals tell:
  /// whatever is longer than a texel crosses one of those. Only for texels of one flat chart; `group` as of
  /// TexelGroups.
  bool free(std::span<const std::uint32_t> group) {
    const atlas::SurfacePoint& first = texels_.points[group[0]];
    const auto width = static_cast<std::uint32_t>(texels_.width);
    std::array<std::array<std::uint32_t, 2>, kGroupSide> rows, columns;  // first and last texel of each
    for (auto* lines : {&rows, &columns}) lines->fill({scene::kNone, scene::kNone});
    const float height = 0.5f * kLift * texelSize(first);
    clear();
    for (std::uint32_t k = 0; k < group.size(); ++k) {
      const atlas::SurfacePoint& p = texels_.points[group[k]];
      if (p.sample_count > 0 || p.geometric_normal != first.geometric_normal) return false;
      const std::uint32_t x = p.texel % width % kGroupSide, y = p.texel / width % kGroupSide;
      for (auto* line : {&rows[y], &columns[x]}) (*line)[(*line)[0] == scene::kNone ? 0 : 1] = group[k];
      setRay(k, trace::offsetOrigin(p.position, p.geometric_normal), p.geometric_normal, 2.0f * height);
    }
    if (tracer_.occludedPacket(packet_) != 0) return false;
    clear();
    for (std::uint32_t i = 0; i < kGroupSide; ++i)
      setAcross(i, rows[i], height, true), setAcross(kGroupSide + i, columns[i], height, false);
    return tracer_.occludedPacket(packet_) == 0;
  }

  /// The places that count; none: nothing can be seen of the texel.
  Mask exposed(std::uint32_t index) {
    lay(texels_.points[index]);
    far_ = 0;
    const Mask covered = lift();
    const Mask open = all() & ~covered;
    if (open == 0) return 0;
    if (covered == 0 && seenFrom(firstOf(open), open) == open) return open;
    return largestParts(open, index);
  }

 private:
  static std::uint32_t firstOf(Mask m) { return static_cast<std::uint32_t>(std::countr_zero(m)); }

  void lay(const atlas::SurfacePoint& p) {
    const float texel = texelSize(p);
    room_ = kLift * texel, gap_ = kGap * texel;
    if (p.sample_count > 0) {
      count_ = std::min(p.sample_count, kMost);
      Normal normal = p.geometric_normal;
      std::uint32_t triangle = p.triangle;
      for (std::uint32_t i = 0; i < count_; ++i) {
        places_[i] = texels_.samples[p.first_sample + i];
        if (places_[i].triangle != triangle) {
          triangle = places_[i].triangle;
          normal = scene::geometricNormal(tracer_.scene(), p.instance, triangle);
          if (normal == Normal(0)) normal = p.geometric_normal;
        }
        normals_[i] = normal;
      }
      return;
    }
    count_ = kMost;
    for (std::uint32_t i = 0; i < kMost; ++i) {
      const float u = (static_cast<float>(i % kSide) + 0.5f) / kSide - 0.5f,
                  v = (static_cast<float>(i / kSide) + 0.5f) / kSide - 0.5f;
      places_[i] = {p.position + u * p.dp_dx + v * p.dp_dy, p.triangle};
      normals_[i] = p.geometric_normal;
    }
  }

  void setRay(std::uint32_t lane, Point from, Direction d, float t_max) {
    packet_.origin_x[lane] = from.x, packet_.origin_y[lane] = from.y, packet_.origin_z[lane] = from.z;
    packet_.direction_x[lane] = d.x, packet_.direction_y[lane] = d.y, packet_.direction_z[lane] = d.z;
    packet_.t_max[lane] = t_max, packet_.alpha_seed[lane] = 0;
  }
  /// From the outer edge of one texel to that of another of its row or column, `height` above them.
  void setAcross(std::uint32_t lane, const std::array<std::uint32_t, 2>& ends, float height, bool row) {
    if (ends[0] == scene::kNone) return;
    const atlas::SurfacePoint &a = texels_.points[ends[0]],
                              &b = texels_.points[ends[1] == scene::kNone ? ends[0] : ends[1]];
    const Vec3 half = 0.5f * (row ? a.dp_dx : a.dp_dy), up = height * a.geometric_normal;
    const Point from = a.position - half + up;
    const Vec3 way = b.position + half + up - from;
    const float length = glm::length(way);
    if (length > 0) setRay(lane, from, way / length, length);
  }
  void clear() {
    for (std::uint32_t lane = 0; lane < kMost; ++lane) setRay(lane, Point(0), Direction(0, 0, 1), -1.0f);
  }
  /// Lanes whose rays meet something opaque; panes and foliage neither cover nor part.
  Mask trace() {
    tracer_.intersectPacket(packet_, hits_);
    Mask met = 0;
    for (Mask left = hits_.hit; left != 0; left &= left - 1) {
      const std::uint32_t lane = firstOf(left);
      if (packet_.t_max[lane] >= 0 && opaque_[hits_.instance[lane]]) met |= 1u << lane;
    }
    return met;
  }

  /// Finds the places' lifted twins; returns what is covered.
  Mask lift() {
    clear();
    for (std::uint32_t i = 0; i < count_; ++i)
      setRay(i, trace::offsetOrigin(places_[i].position, normals_[i]), normals_[i], room_);
    const Mask met = trace();
    Mask covered = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      const bool hit = ((met >> i) & 1u) != 0;
      if (hit && hits_.t[i] < gap_) covered |= 1u << i;
      lifted_[i] = trace::offsetOrigin(places_[i].position, normals_[i]) +
                   (hit ? 0.5f * hits_.t[i] : room_) * normals_[i];
    }
    return covered;
  }

  bool sameFace(std::uint32_t a, std::uint32_t b) const {
    return glm::dot(normals_[a], normals_[b]) > kFoldCosine;
  }

  /// Of `others` those that are on its face and seen from place `from`, and itself; those of other faces too.
  Mask seenFrom(std::uint32_t from, Mask others) {
    clear();
    Mask rays = 0;
    for (Mask left = others & ~(1u << from); left != 0; left &= left - 1) {
      const std::uint32_t i = firstOf(left);
      if (!sameFace(from, i)) continue;
      const Vec3 way = lifted_[i] - lifted_[from];
      const float length = glm::length(way);
      if (!(length > 0)) continue;
      setRay(i, lifted_[from], way / length, kShort * length);
      rays |= 1u << i;
    }
    return others & ~(rays == 0 ? 0u : trace());
  }

  Mask faceOf(std::uint32_t place, Mask among) const {
    Mask face = 0;
    for (Mask left = among; left != 0; left &= left - 1)
      if (sameFace(place, firstOf(left))) face |= 1u << firstOf(left);
    return face;
  }

  /// The places of a face that are reached from one of them, from each to those it sees.
  Mask partOf(std::uint32_t start, Mask face) {
    Mask part = 1u << start, next = part;
    while (next != 0 && part != face) {
      const std::uint32_t i = firstOf(next);
      next &= next - 1;
      const Mask found = seenFrom(i, face & ~part) & face & ~part;
      part |= found, next |= found;
    }
    return part;
  }

  bool buried(Mask part, std::uint32_t index) {
    clear();
    const std::uint32_t stream = streamOf(index, 0, 20);
    Mask left = part;
    for (std::uint32_t ray = 0; ray < kBuriedRays; ++ray) {
      const std::uint32_t i = firstOf(left);
      left &= left - 1;
      if (left == 0) left = part;
      const Direction d = Frame::about(normals_[i]).toWorld(squareToCosineHemisphere(sobol2(ray, stream)));
      setRay(ray, trace::offsetOrigin(places_[i].position, normals_[i]), d, kInfinity);
    }
    const Mask met = trace();
    // Double-sided surfaces have no backs, but a body closed by them is as dark inside.
    if (std::popcount(met & hits_.behind) == kBuriedRays) return true;
    return static_cast<float>(std::popcount(met & hits_.back_face)) > kBuriedShare * kBuriedRays;
  }

  Mask largestParts(Mask open, std::uint32_t index) {
    Mask kept = 0;
    for (Mask faces = open; faces != 0;) {
      const Mask face = faceOf(firstOf(faces), faces);
      faces &= ~face;
      Mask best = 0;
      for (Mask left = face; left != 0;) {
        const Mask part = partOf(firstOf(left), left);
        left &= ~part;
        if (buried(part, index)) continue;
        far_ |= part;
        if (std::popcount(part) > std::popcount(best)) best = part;
      }
      kept |= best;
    }
    far_ &= ~kept;
    // All of it inside something: the solver sees that too, and knows what to do.
    return kept != 0 ? kept : open;
  }

  const trace::Tracer& tracer_;
  const atlas::Texels& texels_;
  std::vector<bool> opaque_;  // by instance
  std::uint32_t count_ = 0;
  Mask far_ = 0;
  float room_ = 0, gap_ = 0;
  std::array<atlas::SubSample, kMost> places_;
  std::array<Normal, kMost> normals_;
  std::array<Point, kMost> lifted_;
  trace::RayPacket packet_;
  trace::HitPacket hits_;
};

Point middle(std::span<const atlas::SubSample> places) {
  Vec3 sum(0.0f);
  for (const atlas::SubSample& p : places) sum += p.position;
  return sum / static_cast<float>(places.size());
}

/// Neighbours of a texel within its chart.
class Neighbours {
 public:
  explicit Neighbours(const atlas::Texels& texels) : texels_(texels) {}

  /// Up to five from `point` along `way`, the best first: along the page's axis that is nearest, aslant, one
  /// texel on. Calls visit(point) until it returns true.
  template <class Visit>
  void along(std::uint32_t point, Vec3 way, const Visit& visit) const {
    const atlas::SurfacePoint& p = texels_.points[point];
    const float x = glm::dot(way, p.dp_dx) / std::max(glm::dot(p.dp_dx, p.dp_dx), 1e-30f),
                y = glm::dot(way, p.dp_dy) / std::max(glm::dot(p.dp_dy, p.dp_dy), 1e-30f);
    const int dx = x < 0 ? -1 : 1, dy = y < 0 ? -1 : 1;
    const bool flat = std::abs(x) >= std::abs(y);
    const std::array<std::pair<int, int>, 5> steps{{{flat ? dx : 0, flat ? 0 : dy},
                                                    {dx, dy},
                                                    {flat ? dx : -dx, flat ? -dy : dy},
                                                    {flat ? 2 * dx : 0, flat ? 0 : 2 * dy},
                                                    {flat ? 0 : dx, flat ? dy : 0}}};
    for (const auto& [right, down] : steps) {
      const std::uint32_t other = at(p, right, down);
      if (other != scene::kNone && visit(other)) return;
    }
  }

 private:
  std::uint32_t at(const atlas::SurfacePoint& p, int dx, int dy) const {
    const int width = texels_.width, height = texels_.height, texel = static_cast<int>(p.texel);
    const int column = texel % width + dx, row = texel / width % height + dy;
    if (column < 0 || column >= width || row < 0 || row >= height) return scene::kNone;
    const auto wanted = static_cast<std::uint32_t>(texel + dy * width + dx);
    const auto found =
        std::lower_bound(texels_.points.begin(), texels_.points.end(), wanted,
                         [](const atlas::SurfacePoint& a, std::uint32_t b) { return a.texel < b; });
    if (found == texels_.points.end() || found->texel != wanted || found->chart != p.chart)
      return scene::kNone;
    return static_cast<std::uint32_t>(found - texels_.points.begin());
  }
  const atlas::Texels& texels_;
};

}  // namespace

namespace {

/// By point: something may stand in its 4 x 4 block, or in one beside it.
std::vector<std::uint8_t> doubtfulTexels(const trace::Tracer& tracer, const atlas::Texels& texels) {
  const auto width = static_cast<std::size_t>(texels.width), height = static_cast<std::size_t>(texels.height);
  const std::size_t across = (width + kGroupSide - 1) / kGroupSide,
                    down = (height + kGroupSide - 1) / kGroupSide;
  const auto blockOf = [&](const atlas::SurfacePoint& p) {
    const std::size_t x = p.texel % width / kGroupSide, row = p.texel / width;
    return (row / height * down + row % height / kGroupSide) * across + x;
  };
  const TexelGroups groups(texels);
  std::vector<std::uint8_t> block(texels.pages * down * across, 0);
  parallelFor(groups.tiles(), 4, [&](std::size_t begin, std::size_t end) {
    TexelParts texel(tracer, texels);
    for (std::size_t tile = begin; tile < end; ++tile)
      groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
        if (!texel.free(group)) block[blockOf(texels.points[group[0]])] = 1;
      });
  });
  std::vector<std::uint8_t> doubtful(texels.points.size(), 0);
  parallelFor(doubtful.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t own = blockOf(texels.points[i]), x = own % across, y = own / across % down;
      for (std::size_t v = y - (y > 0); v <= std::min(y + 1, down - 1); ++v)
        for (std::size_t u = x - (x > 0); u <= std::min(x + 1, across - 1); ++u)
          doubtful[i] |= block[own - y * across - x + v * across + u];
    }
  });
  return doubtful;
}

}  // namespace

struct Exposure::Found {
  std::vector<std::pair<std::uint32_t, Parts>> parts;  // by point
  std::vector<atlas::SubSample> places;
};

Exposure::Exposure(const trace::Tracer& tracer, const atlas::Texels& texels)
    : tracer_(tracer), texels_(texels), state_(texels.points.size(), kWhole) {
  constexpr std::size_t kGrain = 4096;
  std::vector<Found> chunks((state_.size() + kGrain - 1) / kGrain);
  const std::vector<std::uint8_t> doubtful = doubtfulTexels(tracer, texels);
  parallelFor(state_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    TexelParts texel(tracer, texels);
    Found& found = chunks[begin / kGrain];
    for (std::size_t i = begin; i < end; ++i) {
      if (!doubtful[i]) continue;
      const auto point = static_cast<std::uint32_t>(i);
      const Mask kept = texel.exposed(point), far = texel.far();
      if (kept == texel.all()) continue;
      if (kept == 0) {
        state_[i] = kHidden;
        continue;
      }
      Parts parts;
      parts.first = static_cast<std::uint32_t>(found.places.size());
      parts.near = static_cast<std::uint8_t>(std::popcount(kept));
      for (const Mask part : {kept, far})
        for (Mask left = part; left != 0; left &= left - 1)
          found.places.push_back(texel.place(static_cast<std::uint32_t>(std::countr_zero(left))));
      parts.far = static_cast<std::uint8_t>(std::popcount(far));
      found.parts.emplace_back(point, parts);
    }
  });
  for (const Found& found : chunks) {
    for (auto [point, parts] : found.parts) {
      state_[point] = static_cast<std::uint32_t>(parts_.size());
      parts.first += static_cast<std::uint32_t>(places_.size());
      parts_.push_back(parts);
    }
    places_.insert(places_.end(), found.places.begin(), found.places.end());
  }
  // The nearest neighbour over there that is whole, so surely not itself on this side.
  const Neighbours neighbours(texels);
  for (std::uint32_t point = 0; point < state_.size(); ++point) {
    if (state_[point] >= kHidden || parts_[state_[point]].far == 0) continue;
    Parts& parts = parts_[state_[point]];
    neighbours.along(point, middle(farOf(parts)) - middle(nearOf(parts)), [&](std::uint32_t other) {
      const bool whole =
          state_[other] == kWhole || (state_[other] < kHidden && parts_[state_[other]].far == 0);
      if (whole) parts.beyond = other;
      return whole;
    });
  }
}

std::uint32_t Exposure::sideOf(std::uint32_t point, Point origin, Point end) const {
  const Parts& parts = parts_[state_[point]];
  const atlas::SurfacePoint& p = texels_.points[point];
  // The ray itself was free up to its end, so a place on it a little above is on the right side.
  const float lift = 0.5f * kLift * texelSize(p), height = glm::dot(origin - end, p.geometric_normal);
  const Point from = end + std::min(lift / std::max(height, 1e-30f), 1.0f) * (origin - end);
  const auto nearest = [&](std::span<const atlas::SubSample> places) {
    return std::min_element(places.begin(), places.end(),
                            [&](const auto& a, const auto& b) {
                              return glm::dot(a.position - end, a.position - end) <
                                     glm::dot(b.position - end, b.position - end);
                            })
        ->position;
  };
  const auto sees = [&](Point place) {
    const Vec3 way = place + lift * p.geometric_normal - from;
    const float length = glm::length(way);
    return !(length > 0) || !tracer_.occluded({from, way / length, kShort * length});
  };
  const Point near = nearest(nearOf(parts)), far = nearest(farOf(parts));
  if (sees(near)) return point;
  return sees(far) || glm::length(far - end) < glm::length(near - end) ? parts.beyond : point;
}

void Exposure::preferDark(std::span<const float> irradiance) {
  for (std::size_t point = 0; point < state_.size(); ++point) {
    if (state_[point] >= kHidden) continue;
    Parts& parts = parts_[state_[point]];
    parts.far_counts =
        parts.beyond != scene::kNone && irradiance[parts.beyond] < kMuchDarker * irradiance[point];
  }
}

}  // namespace relume::transport
