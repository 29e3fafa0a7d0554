// SPDX-License-Identifier: MIT
// Which part of each texel's footprint is one place that can be seen. A texel is one value, but other bodies
// may stand in its footprint: what they cover, and what lies on their far side, is another place, which would
// darken it or light it through a wall.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "relume/atlas/texels.h"
#include "relume/trace/tracer.h"

namespace relume::transport {

class Exposure {
 public:
  /// Keeps references.
  Exposure(const trace::Tracer& tracer, const atlas::Texels& texels);

  /// Nothing of the point's footprint can be seen: something lies upon all of it.
  bool hidden(std::uint32_t point) const { return state_[point] == kHidden; }
  /// The places that count, equal shares each; none: the whole footprint does.
  std::span<const atlas::SubSample> places(std::uint32_t point) const {
    const std::uint32_t s = state_[point];
    if (s >= kHidden) return {};
    return parts_[s].far_counts ? farOf(parts_[s]) : nearOf(parts_[s]);
  }

  /// One of these places, or of the whole footprint, for u in [0, 1)^2: equal shares for equal shares.
  Point position(std::uint32_t point, Vec2 u) const {
    const auto seen = places(point);
    if (seen.empty()) return atlas::footprintPosition(texels_, texels_.points[point], u);
    const auto count = static_cast<float>(seen.size());
    return seen[std::min(static_cast<std::size_t>(u.x * count), seen.size() - 1)].position;
  }

  /// A wall parts the point's footprint, and a neighbour answers for the smaller side.
  bool parted(std::uint32_t point) const {
    const std::uint32_t s = state_[point];
    return s < kHidden && parts_[s].beyond != scene::kNone;
  }

  /// Which point answers for the end of a ray that met the front of `point`: itself, or, where a wall parts
  /// the footprint and the ray came to the smaller side, a neighbour over there.
  std::uint32_t answering(std::uint32_t point, Point origin, Point end) const {
    return parted(point) ? sideOf(point, origin, end) : point;
  }

  /// Where a wall parts a footprint and `irradiance` (luminance, by point, of the larger parts) is far lower
  /// on the other side, the texel becomes the smaller part: light on the floor of a dark room strikes the
  /// eye, a dark line at the foot of a wall in a lit one does not.
  void preferDark(std::span<const float> irradiance);

 private:
  static constexpr std::uint32_t kWhole = 0xffffffffu, kHidden = 0xfffffffeu;
  struct Parts {
    std::uint32_t first = 0;  // in places_: those of the texel's part, then those beyond
    std::uint8_t near = 0, far = 0;
    bool far_counts = false;
    std::uint32_t beyond = scene::kNone;  // a neighbour on the side of the latter
  };
  struct Found;
  std::uint32_t sideOf(std::uint32_t point, Point origin, Point end) const;
  std::span<const atlas::SubSample> nearOf(const Parts& p) const {
    return std::span(places_).subspan(p.first, p.near);
  }
  std::span<const atlas::SubSample> farOf(const Parts& p) const {
    return std::span(places_).subspan(p.first + p.near, p.far);
  }

  const trace::Tracer& tracer_;
  const atlas::Texels& texels_;
  std::vector<std::uint32_t> state_;  // by point: kWhole, kHidden or an index into parts_
  std::vector<Parts> parts_;
  std::vector<atlas::SubSample> places_;
};

}  // namespace relume::transport
