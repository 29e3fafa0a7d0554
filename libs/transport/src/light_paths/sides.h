// SPDX-License-Identifier: MIT
// The sides of texels that light can reach: all fronts but buried ones, and the backs that rays from them
// meet. A few rays from each find that, and are kept: form factors are made from them.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light_paths/side_rays.h"
#include "relume/core/progress.h"
#include "texel_groups.h"

namespace relume::transport {

class Sides {
 public:
  /// About `rays` in all, 8 to 256 from each side. Keeps references. Throws Error kInterrupted.
  Sides(const SurfaceScene& scene, const TexelGroups& groups, std::uint64_t rays, std::uint64_t seed,
        Progress& progress);

  /// Fronts by point, then backs.
  std::size_t size() const { return points_ + back_point_.size(); }
  std::size_t points() const { return points_; }
  std::uint32_t point(std::size_t side) const {
    return side < points_ ? static_cast<std::uint32_t>(side) : back_point_[side - points_];
  }
  bool isBack(std::size_t side) const { return side >= points_; }
  /// Inside other geometry, or with something upon all of it. Backs are not.
  bool buried(std::size_t side) const { return side < points_ && buried_[side] != 0; }
  std::span<const std::uint8_t> buriedPoints() const { return buried_; }

  /// The side that answers for the end of a ray, which is not buried where any near it is not; scene::kNone:
  /// none.
  std::uint32_t answering(SideOfTexel surface) const {
    if (surface == kNoTexel) return scene::kNone;
    if ((surface & kBackBit) == 0) return answering_[surface];
    const std::uint32_t back = back_of_[surface & ~kBackBit];
    return back == scene::kNone ? scene::kNone : static_cast<std::uint32_t>(points_) + back;
  }

  std::uint32_t raysEach() const { return rays_each_; }
  /// Where the rays of a side ended, raysEach() of them; kNoTexel too for those below the surface.
  std::span<const SideOfTexel> ends(std::size_t side) const {
    return std::span(ends_).subspan(side * rays_each_, rays_each_);
  }
  std::uint64_t rays() const { return rays_; }

  Normal shadingNormal(std::size_t side) const {
    const Normal n = scene_.texels.points[point(side)].shading_normal;
    return isBack(side) ? -n : n;
  }
  Normal geometricNormal(std::size_t side) const {
    const Normal n = scene_.texels.points[point(side)].geometric_normal;
    return isBack(side) ? -n : n;
  }
  float area(std::size_t side) const { return scene_.texels.points[point(side)].area; }

 private:
  struct Surveyor;
  void surveyFronts(Surveyor& surveyor, Progress& progress);
  /// Of blocks whose backs are met by rays since the last call; whether there were any.
  bool surveyBacks(Surveyor& surveyor, std::size_t from_side);

  const SurfaceScene scene_;
  std::size_t points_;
  std::uint32_t rays_each_;
  std::vector<std::uint8_t> buried_;       // by point
  std::vector<std::uint32_t> answering_;   // by point
  std::vector<std::uint32_t> back_of_;     // by point: number of its back
  std::vector<std::uint32_t> back_point_;  // by back
  std::vector<SideOfTexel> ends_;          // by side and ray
  std::uint64_t rays_ = 0;
};

}  // namespace relume::transport
