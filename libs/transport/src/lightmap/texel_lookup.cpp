// SPDX-License-Identifier: MIT
// Every texel that a chart touches is covered, so a hit always lies in a covered texel, but for rounding at
// the rim of a chart: one ring of texels beyond the covered ones refers to a covered neighbour.
#include "lightmap/texel_lookup.h"

#include <algorithm>

namespace relume::transport {

TexelLookup::TexelLookup(const scene::Scene& scene, const atlas::Atlas& atlas, const atlas::Texels& texels)
    : width_(texels.width), height_(texels.height), first_(scene.instances.size(), scene::kNone) {
  std::size_t count = 0;
  for (const atlas::InstanceUv& uv : atlas.instances) count += uv.triangles.size();
  triangles_.reserve(count);
  for (const atlas::InstanceUv& uv : atlas.instances) {
    first_[uv.instance] = static_cast<std::uint32_t>(triangles_.size());
    const auto page = uv.page * static_cast<std::uint32_t>(width_ * height_);
    for (const UVec3 t : uv.triangles)
      triangles_.push_back({uv.uv[t.x], uv.uv[t.y] - uv.uv[t.x], uv.uv[t.z] - uv.uv[t.x], page});
  }

  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  point_of_.assign(texels.pages * width * height + 1, scene::kNone);
  nothing_ = {Vec2(0.0f), Vec2(0.0f), Vec2(0.0f), nowhere()};
  for (std::uint32_t i = 0; i < texels.points.size(); ++i) point_of_[texels.points[i].texel] = i;
  for (std::uint32_t i = 0; i < texels.points.size(); ++i) {
    const std::size_t texel = texels.points[i].texel, x = texel % width, y = texel / width % height;
    const std::size_t page = texel - y * width - x;
    for (std::size_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, height - 1); ++v)
      for (std::size_t u = x > 0 ? x - 1 : 0; u <= std::min(x + 1, width - 1); ++u)
        if (std::uint32_t& point = point_of_[page + v * width + u]; point == scene::kNone) point = i;
  }
}

inline std::uint32_t TexelLookup::texel(const scene::Hit& hit) const {
  const std::uint32_t first = first_[hit.instance];
  if (first == scene::kNone) return nowhere();
  const Triangle& t = triangles_[first + hit.triangle];
  const Vec2 place = t.corner + hit.b1 * t.edge1 + hit.b2 * t.edge2;
  const int x = std::clamp(static_cast<int>(place.x), 0, width_ - 1),
            y = std::clamp(static_cast<int>(place.y), 0, height_ - 1);
  return t.page + static_cast<std::uint32_t>(y * width_ + x);
}

std::uint32_t TexelLookup::point(const scene::Hit& hit) const { return point_of_[texel(hit)]; }

void TexelLookup::texels(const trace::HitPacket& hits, LaneTexels& texel_of) const {
  constexpr std::uint32_t kLanes = trace::RayPacket::kSize;
  std::array<const Triangle*, kLanes> triangle;
  std::array<float, kLanes> b1, b2;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    const bool hit = ((hits.hit >> lane) & 1u) != 0;
    const std::uint32_t first = first_[hit ? hits.instance[lane] : 0];
    triangle[lane] = hit && first != scene::kNone ? &triangles_[first + hits.triangle[lane]] : &nothing_;
    b1[lane] = hit ? hits.b1[lane] : 0.0f, b2[lane] = hit ? hits.b2[lane] : 0.0f;
  }
  std::array<float, kLanes> x, y;
  std::array<std::uint32_t, kLanes> page;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    const Triangle& t = *triangle[lane];
    x[lane] = t.corner.x + b1[lane] * t.edge1.x + b2[lane] * t.edge2.x;
    y[lane] = t.corner.y + b1[lane] * t.edge1.y + b2[lane] * t.edge2.y;
    page[lane] = t.page;
  }
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    const int column = std::clamp(static_cast<int>(x[lane]), 0, width_ - 1),
              row = std::clamp(static_cast<int>(y[lane]), 0, height_ - 1);
    texel_of[lane] = page[lane] + static_cast<std::uint32_t>(row * width_ + column);
  }
}

}  // namespace relume::transport
