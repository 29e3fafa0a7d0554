// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "light_paths/entry_set.h"
#include "light_paths/typical_light.h"
#include "relume/core/error.h"

namespace relume::transport {
namespace {

ShotRays testRays(const trace::Tracer& tracer, std::span<const Box3> boxes, const LightPathOptions& options,
                  Progress& progress) {
  const std::uint32_t count = std::min(options.test_points, options.entries);
  ShotRays rays{.from = {}, .each = 1, .aim = options.aim};
  for (const Light& light : findLights(tracer, boxes, count, {}, options.seed, progress))
    rays.from.push_back(light.position);
  if (rays.from.empty())
    throw Error(ErrorCode::kEmptyScene, "light paths", "there is no room for lights to shoot entries from",
                "take entries=patches");
  rays.each = raysForEntries(tracer, rays, options.entries, options.seed);
  return rays;
}

}  // namespace

EntrySet shotEntries(const PieceScene& scene, std::span<const Box3> boxes, const LightPathOptions& options,
                     Progress& progress) {
  const auto& [surface, sides, pieces, reflectance] = scene;
  EntrySet set;
  Entries& entries = set.entries;
  // What of a piece can be lit: the share of a unit of light on one point of it.
  const std::vector<float> area = areasOf(sides, pieces);
  std::vector<EntryShare> shares;
  const ShotRays rays = testRays(surface.tracer, boxes, options, progress);
  for (const ShotEntry& e : shootEntries(surface.tracer, rays, options.seed, progress)) {
    const float length = glm::length(e.position - e.from);
    const std::uint32_t side = sideWhere(surface, sides, {e.from, (e.position - e.from) / length, length},
                                         {.where = e.where, .t = length}),
                        piece = side == scene::kNone ? side : pieces.of_side[side];
    if (piece == scene::kNone || !(area[piece] > 0)) continue;
    const auto entry = static_cast<std::uint32_t>(entries.area.size());
    shares.push_back({piece, entry, 1.0f / (e.density * area[piece])});
    if (options.transfer == TransferBy::kWalks)
      set.starts.push_back({entry, side, e.position, e.normal, 1.0f / e.density, options.walks});
    const Normal shading = sides.shadingNormal(side);
    set.places.push_back({e.position, shading, e.normal});
    entries.samples.push_back({e.position, shading});
    entries.area.push_back(1.0f / e.density);
    entries.centre.push_back(e.position), entries.normal.push_back(shading);
  }
  if (entries.area.empty())
    throw Error(ErrorCode::kEmptyScene, "light paths", "no entry could be shot at a surface with texels",
                "take entries=patches");
  entries.samples_each = 1;
  entries.setMeans(entries.area.size());
  set.on_pieces = PieceEntries(pieces.size(), std::move(shares));
  double seen = 0;
  for (const float a : entries.area) seen += static_cast<double>(a);
  set.spacing = static_cast<float>(std::sqrt(seen / static_cast<double>(entries.size())));
  return set;
}

}  // namespace relume::transport
