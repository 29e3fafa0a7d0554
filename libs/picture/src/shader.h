// SPDX-License-Identifier: MIT
// What colour a surface shows in each view.
// Based on:
//   [IKSZ03] Iones, Krupkin, Sbert, Zhukov. Fast, Realistic Lighting for Video Games. 2003. Section 4, eqs
//   (4)-(7).
#pragma once
#include <span>

#include "direct_light.h"
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
      : tracer_(tracer), baked_(baked), options_(options) {}

  /// At most Tracer::kPacket points.
  void shade(std::span<const ShadingPoint> points, std::span<Vec3> colours) const;

 private:
  Vec3 lit(const ShadingPoint& point, const Receiver& receiver, Irradiance direct) const;
  Vec3 data(const ShadingPoint& point, const Receiver& receiver) const;

  const LayeredTracer& tracer_;
  const BakedValues& baked_;
  const PictureOptions& options_;
};

}  // namespace relume::picture
