// SPDX-License-Identifier: MIT
// Light that arrives straight from lamps, with ray-traced shadows.
// Based on:
//   [IKSZ03] Iones, Krupkin, Sbert, Zhukov. Fast, Realistic Lighting for Video Games. 2003. Section 4.3, eqs
//   (6), (7).
#pragma once
#include <span>

#include "layered_tracer.h"
#include "relume/core/light.h"

namespace relume::picture {

/// A receiver of light.
struct Receiver {
  Point position{0.0f};
  Normal geometric{0, 0, 1}, shading{0, 0, 1};  ///< both on the lit side
  Point shadow_origin{0.0f};                    ///< where its shadow rays start; see shadowOrigin
  std::uint32_t pixel = 0, sample = 0;          ///< choose the random numbers
};

/// From where on a triangle with smooth normals to send shadow rays, so that a coarse mesh has no jagged line
/// between light and shade: the point raised to the rounder surface that the vertex normals tell of
/// ([Hanika21]). p itself where the normals are flat. `lit_side`: a normal on the side that is lit.
Point shadowOrigin(const scene::Scene& scene, const scene::Hit& hit, Point p, Normal lit_side);

/// I_S of eq. (6): sum over lights of irradiance from what is visible of them. Point, spot and directional
/// lights have sharp shadows; of an area light the visible share of its disk is estimated by 4 stratified
/// points for each sample of a pixel. At most Tracer::kPacket receivers.
void directIrradiance(const LayeredTracer& tracer, const LightSet& lights,
                      std::span<const Receiver> receivers, std::span<Irradiance> result);

/// Sum of eq. (7), without beta: every light as if it faced p and nothing stood between.
Irradiance unoccludedIrradiance(const LightSet& lights, Point p);

}  // namespace relume::picture
