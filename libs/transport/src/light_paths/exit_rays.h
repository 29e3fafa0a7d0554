// SPDX-License-Identifier: MIT
// What an exit sees: rays from all over its texels, as weights of the light on what they meet.
#pragma once
#include <cstdint>
#include <vector>

#include "light_paths/elements.h"
#include "light_paths/side_rays.h"
#include "radiosity/patches.h"

namespace relume::transport {

/// Irradiance of an exit = sum of direct[i].value times light straight from lights on piece direct[i].index +
/// sum of reflected[i].value times other light on element reflected[i].index.
struct ExitView {
  std::vector<Weight> direct, reflected;
};

/// What exit rays share.
struct ExitScene {
  const SurfaceScene& surface;
  const Patches& exits;
  const Sides& sides;
  const Pieces& pieces;
  const Elements& elements;
  const MeanReflectance& reflectance;
  const SampleTable& samples;
  std::uint32_t rays;  ///< of an exit, at least
  std::uint64_t seed;
  float near;  ///< metres: nearer ends are left out
};

/// One thread's.
class ExitRays {
 public:
  explicit ExitRays(const ExitScene& scene);
  /// The same bits every time.
  void look(std::size_t exit, ExitView& view);
  std::uint64_t rays() const { return rays_.rays(); }

 private:
  const ExitScene& scene_;
  SideRays rays_;
  WeightSum direct_, reflected_;
};

}  // namespace relume::transport
