// SPDX-License-Identifier: MIT
// From a hit to the texel that holds it.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "relume/atlas/atlas.h"
#include "relume/atlas/texels.h"
#include "relume/trace/tracer.h"

namespace relume::transport {

using LaneTexels = std::array<std::uint32_t, trace::RayPacket::kSize>;

class TexelLookup {
 public:
  TexelLookup(const scene::Scene& scene, const atlas::Atlas& atlas, const atlas::Texels& texels);

  /// Index into Texels::points; scene::kNone where the surface has no texel (degenerate triangles).
  std::uint32_t point(const scene::Hit& hit) const;

  /// Texels of all pages, and one more that stands for no texel at all.
  std::size_t texels() const { return point_of_.size(); }
  std::uint32_t pointOf(std::uint32_t texel) const { return point_of_[texel]; }

  /// By lane: the texel where its ray ends; the one that stands for none where it does not.
  void texels(const trace::HitPacket& hits, LaneTexels& texel) const;

 private:
  /// In the texels of its page; a cache line holds two.
  struct alignas(32) Triangle {
    Vec2 corner, edge1, edge2;
    std::uint32_t page = 0;  ///< its first texel
  };

  std::uint32_t nowhere() const { return static_cast<std::uint32_t>(point_of_.size() - 1); }
  std::uint32_t texel(const scene::Hit& hit) const;

  int width_, height_;
  std::vector<std::uint32_t> first_;  ///< by instance: its triangle 0 in triangles_; scene::kNone: no texels
  std::vector<Triangle> triangles_;
  Triangle nothing_;                     ///< all of it lies in the texel that stands for none
  std::vector<std::uint32_t> point_of_;  ///< by texel
};

}  // namespace relume::transport
