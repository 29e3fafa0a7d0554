// SPDX-License-Identifier: MIT
// The rays of one texel: where they start and where they go.
#pragma once
#include <array>
#include <cstdint>

#include "direction_batch.h"
#include "ray_frame.h"
#include "relume/atlas/texels.h"

namespace relume::transport {

/// Rays in sorted order. A ray with t_max < 0 is below the surface and not traced.
struct alignas(64) RayBatch {
  std::array<float, kMaxBatch> origin_x, origin_y, origin_z, direction_x, direction_y, direction_z, t_max;
  std::array<std::uint32_t, kMaxBatch> alpha_seed;
  std::array<std::uint16_t, kMaxBatch> code;  ///< of DirectionBatch
};

class TexelRays {
 public:
  /// Random numbers are a function of (seed, point.texel).
  TexelRays(const scene::Scene& scene, const atlas::Texels& texels, const atlas::SurfacePoint& point,
            std::uint64_t seed);

  /// Samples first .. first + count - 1 of the texel's sequence (direction_batch.h says which runs there
  /// are). Rays start all over the texel's footprint and end at `limit`.
  void generate(std::uint32_t first, std::uint32_t count, float limit, RayBatch& rays) const;

 private:
  struct Place {
    Point origin;
    Normal geometric_normal;
    Frame shading;
  };

  RayFrame frame_;
  std::uint32_t direction_stream_, place_stream_, alpha_stream_;
  std::uint32_t place_count_ = 0;  // 0: a parallelogram about centre_
  std::array<Place, 16> places_;
  Point centre_;
  Vec3 dp_dx_, dp_dy_;
};

}  // namespace relume::transport
