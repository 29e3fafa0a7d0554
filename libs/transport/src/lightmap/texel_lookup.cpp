// SPDX-License-Identifier: MIT
// Every texel that a chart touches is covered, so a hit always lies in a covered texel, but for rounding at
// the rim of a chart: one ring of texels beyond the covered ones refers to a covered neighbour.
#include "lightmap/texel_lookup.h"

#include <algorithm>

namespace relume::transport {

TexelLookup::TexelLookup(const scene::Scene& scene, const atlas::Atlas& atlas, const atlas::Texels& texels)
    : width_(texels.width), height_(texels.height), uses_(scene.instances.size()) {
  std::size_t count = 0;
  for (const atlas::InstanceUv& uv : atlas.instances) count += uv.triangles.size();
  triangles_.reserve(count);
  for (const atlas::InstanceUv& uv : atlas.instances) {
    uses_[uv.instance] = {static_cast<std::uint32_t>(triangles_.size()), uv.page};
    for (const UVec3 t : uv.triangles) triangles_.push_back({uv.uv[t.x], uv.uv[t.y], uv.uv[t.z]});
  }

  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  point_of_.assign(texels.pages * width * height, scene::kNone);
  for (std::uint32_t i = 0; i < texels.points.size(); ++i) point_of_[texels.points[i].texel] = i;
  for (std::uint32_t i = 0; i < texels.points.size(); ++i) {
    const std::size_t texel = texels.points[i].texel, x = texel % width, y = texel / width % height;
    const std::size_t page = texel - y * width - x;
    for (std::size_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, height - 1); ++v)
      for (std::size_t u = x > 0 ? x - 1 : 0; u <= std::min(x + 1, width - 1); ++u)
        if (std::uint32_t& point = point_of_[page + v * width + u]; point == scene::kNone) point = i;
  }
}

std::uint32_t TexelLookup::point(const scene::Hit& hit) const {
  const Use& use = uses_[hit.instance];
  if (use.first == scene::kNone) return scene::kNone;
  const auto& [a, b, c] = triangles_[use.first + hit.triangle];
  const Vec2 place = a + hit.b1 * (b - a) + hit.b2 * (c - a);
  const int x = std::clamp(static_cast<int>(place.x), 0, width_ - 1),
            y = std::clamp(static_cast<int>(place.y), 0, height_ - 1);
  const std::size_t row =
      static_cast<std::size_t>(use.page) * static_cast<std::size_t>(height_) + static_cast<std::size_t>(y);
  return point_of_[row * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
}

}  // namespace relume::transport
