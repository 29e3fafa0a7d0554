// SPDX-License-Identifier: MIT
// What colour a surface shows in each view.
// Based on:
//   [IKSZ03] Iones, Krupkin, Sbert, Zhukov. Fast, Realistic Lighting for Video Games. 2003. Section 4, eqs
//   (4)-(7).
#pragma once
#include <optional>
#include <span>

#include "direct_light.h"
#include "relume/picture/baked_directions.h"
#include "relume/picture/baked_values.h"

namespace relume::picture {

/// A place that a primary ray meets.
struct ShadingPoint {
  scene::Hit where;
  Direction to_viewer{0, 0, 1};
  std::uint32_t pixel = 0, sample = 0;
};

class Shader {
 public:
  Shader(const LayeredTracer& tracer, const BakedValues& baked, const PictureOptions& options)
      : tracer_(tracer), baked_(baked), options_(options) {
    if (options.view == View::kLightmap && isDirectional(*baked.layer()))
      directions_.emplace(*baked.layer(), baked.table());
  }

  /// At most Tracer::kPacket points.
  void shade(std::span<const ShadingPoint> points, std::span<Vec3> colours) const;

 private:
  Vec3 lit(const ShadingPoint& point, const Receiver& receiver, Irradiance direct) const;
  /// Of a layer that knows light by direction.
  Vec3 lightFromAllSides(const ShadingPoint& point, const Receiver& receiver, const scene::Surface& surface,
                         const BakedValues::Place& place) const;
  Vec3 data(const ShadingPoint& point, const Receiver& receiver) const;

  const LayeredTracer& tracer_;
  const BakedValues& baked_;
  const PictureOptions& options_;
  std::optional<BakedDirections> directions_;
};

}  // namespace relume::picture
