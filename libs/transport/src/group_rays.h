// SPDX-License-Identifier: MIT
// The rays of the texels of a group, packet by packet: where they start and where they go.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ray_frame.h"
#include "relume/atlas/texels.h"
#include "relume/trace/tracer.h"
#include "sample_table.h"
#include "texel_groups.h"

namespace relume::transport {

class GroupRays {
 public:
  static constexpr std::uint32_t kLanes = trace::RayPacket::kSize;

  GroupRays(const scene::Scene& scene, const atlas::Texels& texels, const SampleTable& samples,
            std::uint64_t seed, float limit);

  /// group: indices into Texels::points, at most kGroupTexels.
  void begin(std::span<const std::uint32_t> group);

  /// Packets from now on hold these texels (places in the group, increasing). Where they are few, a packet
  /// holds several samples of each, at most `most_samples`, a power of two.
  void select(std::span<const std::uint32_t> active, std::uint32_t most_samples);
  std::uint32_t samplesPerPacket() const { return kLanes / lanes_per_sample_; }
  std::uint32_t texelOf(std::uint32_t lane) const { return texel_[lane]; }  ///< place in the group
  std::uint32_t sampleOf(std::uint32_t lane) const { return lane / lanes_per_sample_; }  ///< of the packet's
  /// Where a lane belongs in an array of rows of 16 places whose first row is the packet's first sample.
  std::uint32_t slotOf(std::uint32_t lane) const { return slot_[lane]; }
  bool everyLaneInItsSlot() const { return dense_; }  ///< slotOf(lane) == lane, all used
  bool used(std::uint32_t lane) const { return used_[lane]; }

  /// Samples first .. first + samplesPerPacket() - 1 of the selected texels. t_max < 0: no ray, because the
  /// lane is not used or the direction is below the surface.
  void packet(std::uint32_t first, trace::RayPacket& packet) const;

  /// The column of a texel in the sample table.
  std::uint32_t columnOf(std::uint32_t texel) const { return sources_[texel].column; }

 private:
  struct Place {
    Point origin;
    Normal geometric_normal;
    Frame shading;
  };
  struct Source {
    RayFrame frame{Normal(0, 0, 1), Normal(0, 0, 1)};
    Point centre;
    Vec3 dp_dx, dp_dy;
    std::uint32_t column = 0, alpha_stream = 0;
    std::uint32_t place_count = 0;  // 0: a parallelogram about centre
    std::array<Place, 16> places;
  };
  struct alignas(64) Lanes {
    float tx[kLanes], ty[kLanes], tz[kLanes], bx[kLanes], by[kLanes], bz[kLanes], nx[kLanes], ny[kLanes],
        nz[kLanes];
    float gx[kLanes], gy[kLanes], gz[kLanes];
    float cx[kLanes], cy[kLanes], cz[kLanes], ux[kLanes], uy[kLanes], uz[kLanes], vx[kLanes], vy[kLanes],
        vz[kLanes];
    float limit[kLanes];
    std::uint32_t at[kLanes];  // of the packet's first sample in the table, for packet 0
    std::uint32_t alpha[kLanes];
  };

  void prepare(const atlas::SurfacePoint& point, Source& source) const;

  const scene::Scene& scene_;
  const atlas::Texels& texels_;
  const SampleTable& samples_;
  const std::uint64_t seed_;
  const float limit_;
  std::array<Source, kGroupTexels> sources_;
  Lanes lanes_{};
  std::array<std::uint32_t, kLanes> texel_{};
  std::array<std::uint32_t, kLanes> slot_{};
  std::array<bool, kLanes> used_{};
  std::uint32_t lanes_per_sample_ = kLanes;
  bool in_order_ = false;  // lane i takes column i of the same sample
  bool dense_ = false;
  std::vector<std::uint32_t> uneven_;  // lanes whose texels have places
};

}  // namespace relume::transport
