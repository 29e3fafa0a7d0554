// SPDX-License-Identifier: MIT
#include "light_paths/sides.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "group_solving.h"
#include "lightmap/substitutes.h"
#include "relume/core/parallel.h"
#include "relume/transport/occlusion.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kFewest = 8, kMost = 256;  // rays of a side
constexpr int kMostRounds = 4;                     // of backs seen from backs

}  // namespace

struct Sides::Surveyor {
  const TexelGroups& groups;
  const SampleTable& samples;
  std::uint64_t seed;
  Progress& progress;

  /// Calls visit(group) for all groups, from many threads; each with rays of its own.
  template <class Solve>
  void forEachGroup(const SurfaceScene& scene, std::atomic<std::uint64_t>& rays, const Solve& solve) const {
    parallelFor(
        groups.tiles(), 1,
        [&](std::size_t begin, std::size_t end) {
          SideRays side_rays(scene, samples, seed, Alignment::kTurnedByBlock);
          for (std::size_t tile = begin; tile < end; ++tile)
            groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) { solve(side_rays, group); });
          rays += side_rays.rays();
        },
        &progress);
  }
};

Sides::Sides(const SurfaceScene& scene, const TexelGroups& groups, std::uint64_t rays, std::uint64_t seed,
             Progress& progress)
    : scene_(scene),
      points_(scene.texels.points.size()),
      rays_each_(std::clamp(std::bit_ceil(static_cast<std::uint32_t>(
                                std::min<std::uint64_t>(rays / std::max<std::size_t>(points_, 1), kMost))),
                            kFewest, kMost)),
      buried_(points_, 0),
      back_of_(points_, scene::kNone),
      ends_(points_ * rays_each_, kNoTexel) {
  const SampleTable samples(rays_each_, rays_each_, seed, BlockSamples::kShared);
  const Stage stage(progress, "survey", groups.tiles());
  Surveyor surveyor{groups, samples, seed, progress};
  surveyFronts(surveyor, progress);
  answering_ = substitutes(scene.texels, buried_);
  std::size_t from = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::size_t next = size();
    if (!surveyBacks(surveyor, from)) break;
    from = next;
  }
}

void Sides::surveyFronts(Surveyor& surveyor, Progress&) {
  std::atomic<std::uint64_t> rays = 0;
  surveyor.forEachGroup(scene_, rays, [&](SideRays& side_rays, std::span<const std::uint32_t> group) {
    std::array<std::uint32_t, kGroupTexels> met{}, backs{};
    side_rays.trace(group, Side::kFront, rays_each_,
                    [&](std::uint32_t texel, std::uint32_t sample, const SideRays::End& end) {
                      ends_[group[texel] * std::size_t{rays_each_} + sample] = end.surface;
                      ++met[texel], backs[texel] += end.back;
                    });
    for (std::size_t i = 0; i < group.size(); ++i)
      buried_[group[i]] = scene_.exposure.hidden(group[i]) ||
                          static_cast<float>(backs[i]) > kBuriedShare * static_cast<float>(met[i]);
  });
  rays_ += rays;
}

bool Sides::surveyBacks(Surveyor& surveyor, std::size_t from_side) {
  std::vector<std::uint8_t> met(points_, 0);
  bool any = false;
  for (std::size_t side = from_side; side < size(); ++side) {
    if (buried(side)) continue;
    for (const SideOfTexel end : ends(side))
      if (end != kNoTexel && (end & kBackBit) != 0 && back_of_[end & ~kBackBit] == scene::kNone)
        met[end & ~kBackBit] = 1, any = true;
  }
  if (!any) return false;
  // All texels of a block, so that pieces of backs are as large as those of fronts.
  const std::size_t before = back_point_.size();
  for (std::size_t tile = 0; tile < surveyor.groups.tiles(); ++tile)
    surveyor.groups.forEachGroup(tile, [&](std::span<const std::uint32_t> group) {
      if (std::none_of(group.begin(), group.end(), [&](std::uint32_t i) { return met[i] != 0; })) return;
      for (const std::uint32_t i : group)
        if (back_of_[i] == scene::kNone)
          back_of_[i] = static_cast<std::uint32_t>(back_point_.size()), back_point_.push_back(i);
    });
  ends_.resize(size() * rays_each_, kNoTexel);
  std::atomic<std::uint64_t> rays = 0;
  surveyor.forEachGroup(scene_, rays, [&](SideRays& side_rays, std::span<const std::uint32_t> group) {
    std::array<std::uint32_t, kGroupTexels> fresh;
    std::size_t count = 0;
    for (const std::uint32_t i : group)
      if (back_of_[i] != scene::kNone && back_of_[i] >= before) fresh[count++] = i;
    if (count == 0) return;
    const auto of = std::span<const std::uint32_t>(fresh).first(count);
    side_rays.trace(of, Side::kBack, rays_each_,
                    [&](std::uint32_t texel, std::uint32_t sample, const SideRays::End& end) {
                      const std::size_t side = points_ + back_of_[of[texel]];
                      ends_[side * rays_each_ + sample] = end.surface;
                    });
  });
  rays_ += rays;
  return true;
}

}  // namespace relume::transport
