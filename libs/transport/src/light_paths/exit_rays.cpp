// SPDX-License-Identifier: MIT
#include "light_paths/exit_rays.h"

#include <algorithm>
#include <bit>

namespace relume::transport {
namespace {

constexpr std::uint32_t kFewest = 16;  // rays of a texel

}  // namespace

ExitRays::ExitRays(const ExitScene& scene)
    : scene_(scene),
      rays_(scene.surface, scene.samples, scene.seed, Alignment::kTurned),
      direct_(scene.pieces.size()),
      reflected_(scene.elements.size()) {}

void ExitRays::look(std::size_t exit, ExitView& view) {
  view.direct.clear(), view.reflected.clear();
  const atlas::Texels& texels = scene_.surface.texels;
  const Patch& patch = scene_.exits.all[exit];
  const std::uint32_t each =
      std::clamp(std::bit_ceil((scene_.rays + patch.count - 1) / patch.count), kFewest,
                 static_cast<std::uint32_t>(scene_.samples.x.size() / SampleTable::kColumns));
  scene_.exits.forEachGroup(texels, exit, [&](std::span<const std::uint32_t> group) {
    rays_.trace(group, Side::kFront, each, [&](std::uint32_t texel, std::uint32_t, const SideRays::End& end) {
      if (end.distance < scene_.near) return;
      const std::uint32_t side = scene_.sides.answering(end.surface);
      if (side == scene::kNone || scene_.pieces.of_side[side] == scene::kNone) return;
      const float area = texels.points[group[texel]].area;
      const float share = patch.area > 0 ? area / patch.area : 1.0f / static_cast<float>(patch.count);
      const std::uint32_t point = scene_.sides.point(side), piece = scene_.pieces.of_side[side];
      const Vec3 rho = scene_.reflectance.value[point] * (share / static_cast<float>(each));
      direct_.add(piece, rho * scene_.reflectance.direct[point]);
      reflected_.add(scene_.elements.of_piece[piece], rho * scene_.elements.shape[piece]);
    });
  });
  direct_.take(view.direct), reflected_.take(view.reflected);
}

}  // namespace relume::transport
