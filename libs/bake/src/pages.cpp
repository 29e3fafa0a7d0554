// SPDX-License-Identifier: MIT
#include "pages.h"

#include <algorithm>
#include <cmath>

#include "report_numbers.h"

namespace relume::bake {

asset::Plane finishPlane(const atlas::Texels& texels, std::span<const atlas::SeamSample> seams,
                         std::span<const std::uint8_t> valid, PointPlane plane, LayerReport* report) {
  asset::Plane out;
  out.name = plane.name;
  out.channels = plane.channels;
  std::vector<std::uint8_t> covered;
  atlas::scatter(texels, plane.values, plane.channels, valid, out.values, covered);
  plane.values = {};
  atlas::dilate(texels.width, texels.height, texels.pages, plane.channels, out.values, covered, &texels);
  if (report) report->seams_before = seamError(seams, plane.channels, out.values);
  constexpr float kFidelity = 0.1f;
  if (!plane.direction)
    atlas::stitchSeams(seams, plane.channels, out.values, kFidelity,
                       covered);  // a bent normal may turn at a crease
  // Sunlit or near a lamp an irradiance may be more than half a float can say.
  constexpr float kLargestHalf = 65504.0f;
  const auto fits = [](float v) { return std::abs(v) <= kLargestHalf; };
  out.storage = std::all_of(out.values.begin(), out.values.end(), fits) ? asset::Storage::kFloat16
                                                                        : asset::Storage::kFloat32;
  if (plane.unit_interval)
    for (float& v : out.values) v = std::clamp(v, 0.0f, 1.0f);
  if (plane.unorm8) {
    for (float& v : out.values) v = std::clamp(v, plane.lo, plane.hi);
    out.storage = asset::Storage::kUnorm8, out.lo = plane.lo, out.hi = plane.hi;
  }
  if (report) report->seams_after = seamError(seams, plane.channels, out.values);
  if (plane.direction) {
    for (std::size_t i = 0; i + 2 < out.values.size(); i += 3) {
      Vec3 d(out.values[i], out.values[i + 1], out.values[i + 2]);
      const float length = glm::length(d);
      d = length > 1e-6f ? d / length : Vec3(0, 1, 0);
      out.values[i] = d.x, out.values[i + 1] = d.y, out.values[i + 2] = d.z;
    }
  }
  return out;
}

}  // namespace relume::bake
