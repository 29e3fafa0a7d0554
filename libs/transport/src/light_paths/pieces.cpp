// SPDX-License-Identifier: MIT
#include "light_paths/pieces.h"

#include <array>
#include <cmath>
#include <utility>

#include "radiosity/patches.h"
#include "relume/core/parallel.h"

namespace relume::transport {
namespace {

constexpr std::uint32_t kLargestBlock = 64;  // texels

// From how far above the surface the parts of a block look for its middle, in sides of the block.
constexpr float kHeight = 0.25f;

/// Adds up pieces from the patches of sides. What does not see the middle of its patch, because a wall stands
/// between them, is a piece of its own.
class Collector {
 public:
  Collector(const SurfaceScene& scene, const Sides& sides, std::uint32_t block)
      : scene_(scene), sides_(sides) {
    pieces_.block = block, pieces_.of_side.assign(sides.size(), scene::kNone);
  }
  /// Those sides that `mine` accepts, in the blocks of `patches`.
  template <class Mine>
  void add(const Patches& patches, const Mine& mine) {
    std::vector<Part> part(sides_.size(), kNotMine);
    parallelFor(part.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t side = begin; side < end; ++side)
        if (!sides_.buried(side) && mine(side)) part[side] = partOf(side, patches);
    });
    // By patch: fronts, backs, and what stands apart of them.
    std::vector<std::array<std::uint32_t, 4>> piece_of(patches.size());
    for (auto& p : piece_of) p.fill(scene::kNone);
    for (std::size_t side = 0; side < part.size(); ++side) {
      if (part[side] == kNotMine) continue;
      const std::uint32_t patch = patches.patch_of[sides_.point(side)];
      const std::size_t kind = (sides_.isBack(side) ? 1u : 0u) + (part[side] == kApart ? 2u : 0u);
      std::uint32_t& piece = piece_of[patch][kind];
      if (piece == scene::kNone) {
        piece = static_cast<std::uint32_t>(pieces_.size());
        const Patch& p = patches.all[patch];
        if (part[side] == kApart) {
          pieces_.all.push_back(
              {scene_.texels.points[sides_.point(side)].position, sides_.shadingNormal(side), 0.0f});
        } else {
          pieces_.all.push_back({p.centre, sides_.isBack(side) ? -p.normal : p.normal, 0.0f});
        }
      }
      pieces_.of_side[side] = piece;
    }
  }
  /// Areas by the rays of others: A_j F_ji summed over all j is A_i where all that i sees is surface.
  Pieces take() {
    std::vector<double> seen(pieces_.size(), 0.0);
    for (std::size_t side = 0; side < sides_.size(); ++side) {
      if (pieces_.of_side[side] == scene::kNone) continue;
      const double share = static_cast<double>(sides_.area(side)) / sides_.raysEach();
      for (const SideOfTexel end : sides_.ends(side)) {
        const std::uint32_t met = sides_.answering(end);
        if (met != scene::kNone && pieces_.of_side[met] != scene::kNone) seen[pieces_.of_side[met]] += share;
      }
    }
    for (std::size_t i = 0; i < seen.size(); ++i) pieces_.all[i].area = static_cast<float>(seen[i]);
    return std::move(pieces_);
  }

 private:
  enum Part : std::uint8_t { kNotMine, kTogether, kApart };
  Part partOf(std::size_t side, const Patches& patches) const {
    const atlas::SurfacePoint& point = scene_.texels.points[sides_.point(side)];
    const Patch& patch = patches.all[patches.patch_of[sides_.point(side)]];
    if (patch.count == 1) return kTogether;
    const float height = kHeight * std::sqrt(patch.area), sign = sides_.isBack(side) ? -1.0f : 1.0f;
    const Point from = point.position + sign * height * point.geometric_normal,
                to = patch.centre + sign * height * patch.geometric_normal;
    const float length = glm::length(to - from);
    if (!(length > 0)) return kTogether;
    return scene_.tracer.occluded({from, (to - from) / length, length}) ? kApart : kTogether;
  }

  const SurfaceScene& scene_;
  const Sides& sides_;
  Pieces pieces_;
};

}  // namespace

Pieces makePieces(const SurfaceScene& scene, const Sides& sides, std::size_t most) {
  const double backs = static_cast<double>(sides.size()) / static_cast<double>(sides.points());
  for (std::uint32_t block = 1;; block *= 2) {
    // Too many for sure: spares the sorting of texels.
    if (block<kLargestBlock&& static_cast<double>(sides.size())> static_cast<double>(most) * block * block)
      continue;
    const Patches patches = makePatches(scene.texels, block, sides.buriedPoints());
    if (static_cast<double>(patches.size()) * backs > static_cast<double>(most) && block < kLargestBlock)
      continue;
    Collector collector(scene, sides, block);
    collector.add(patches, [](std::size_t) { return true; });
    return collector.take();
  }
}

Pieces refinedPieces(const SurfaceScene& scene, const Sides& sides, const Pieces& coarse,
                     std::span<const float> importance, std::size_t most) {
  double all = 0;
  for (std::size_t i = 0; i < coarse.size(); ++i)
    all += static_cast<double>(coarse.all[i].area * importance[i]);
  const double share = all / static_cast<double>(most);
  // By coarse piece: the block whose area is a share.
  std::vector<std::uint32_t> block_of(coarse.size());
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    double area = static_cast<double>(coarse.all[i].area * importance[i]);
    std::uint32_t block = coarse.block;
    for (; block > 1 && area > 1.5 * share; block /= 2) area /= 4;
    block_of[i] = block;
  }
  Collector collector(scene, sides, coarse.block);
  for (std::uint32_t block = coarse.block; block > 0; block /= 2) {
    const auto mine = [&](std::size_t side) { return block_of[coarse.of_side[side]] == block; };
    collector.add(makePatches(scene.texels, block, sides.buriedPoints()), mine);
  }
  return collector.take();
}

}  // namespace relume::transport
