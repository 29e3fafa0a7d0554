// SPDX-License-Identifier: MIT
// The rays of the texels of a group, packet by packet: where they start and where they go.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "lightmap/exposure.h"
#include "ray_frame.h"
#include "relume/atlas/texels.h"
#include "relume/trace/tracer.h"
#include "sample_table.h"
#include "texel_groups.h"

namespace relume::transport {

/// Of a surface: where its normals point to, or the other.
enum class Side : std::uint8_t { kFront, kBack };

/// Turns frames about their normals.
class Turn {
 public:
  Turn() = default;
  explicit Turn(std::uint32_t bits) : cosine_(std::cos(angleOf(bits))), sine_(std::sin(angleOf(bits))) {}
  Frame operator()(const Frame& f) const {
    return {cosine_ * f.t + sine_ * f.b, cosine_ * f.b - sine_ * f.t, f.n};
  }

 private:
  static float angleOf(std::uint32_t bits) { return static_cast<float>(bits >> 8) * (2.0f * kPi * 0x1p-24f); }
  float cosine_ = 1.0f, sine_ = 0.0f;
};

/// Whether blocks of all charts send rays along the same directions of their frames, or each chart (and patch
/// of a large one) turns them: what the same directions miss on walls that are alike does not average out,
/// but where walls stand square to each other, as in most buildings, they have 10 % less noise. Or each block
/// for itself: best for sums over many blocks.
enum class Alignment : std::uint8_t { kSame, kTurned, kTurnedByBlock };

class GroupRays {
 public:
  static constexpr std::uint32_t kLanes = trace::RayPacket::kSize;

  GroupRays(const scene::Scene& scene, const atlas::Texels& texels, const SampleTable& samples,
            std::uint64_t seed, float limit, Alignment alignment = Alignment::kSame,
            const Exposure* exposure = nullptr);

  /// group: indices into Texels::points, at most kGroupTexels.
  void begin(std::span<const std::uint32_t> group, Side side = Side::kFront);

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

  struct Normals {
    Normal geometric, shading;
  };
  /// Of the place where a lane's ray starts, in the packet that begins with sample `first`.
  Normals normals(std::uint32_t first, std::uint32_t lane) const;

  /// A place in the footprint of a texel of the group, for u in [0, 1)^2.
  struct Spot {
    Point origin;  ///< off the surface: where rays start
    Normal geometric_normal, shading_normal;
  };
  Spot spot(std::uint32_t texel, Vec2 u) const;

  /// In [0, 1)^2: sets samples apart from those of other charts and patches.
  Vec2 shift() const { return shift_; }

  /// Seed of a texel's decisions about alpha.
  std::uint32_t alphaStream(std::uint32_t texel) const { return sources_[texel].alpha_stream; }

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
    const Place& place(float u) const {
      return places[std::min(static_cast<std::uint32_t>(u * static_cast<float>(place_count)),
                             place_count - 1)];
    }
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

  /// Samples of the lanes of a packet.
  struct SampleRows {
    const float *x, *y, *z, *u, *v;
  };

  void turn(const atlas::SurfacePoint& point);
  void prepare(std::uint32_t index, Side side, Source& source) const;
  /// `rays` and `sample` share no memory: what is sure of that becomes vector code.
  void fill(const SampleRows& sample, std::uint32_t first, trace::RayPacket& rays) const;

  const scene::Scene& scene_;
  const atlas::Texels& texels_;
  const SampleTable& samples_;
  const std::uint64_t seed_;
  const float limit_;
  const Alignment alignment_;
  const Exposure* exposure_;
  Turn turn_;
  Vec2 shift_{0.0f};
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
