// SPDX-License-Identifier: MIT
// A place where a random walk meets a surface.
#pragma once
#include "relume/scene/scene.h"
#include "relume/transport/bsdf.h"
#include "relume/transport/reference.h"

namespace relume::transport {

struct Vertex {
  Point position;
  Normal geometric;     ///< on the outgoing direction's side
  bool behind = false;  ///< that is not the side that the surface's normal points to
  Bsdf bsdf = Bsdf::lambert({0, 0, 1}, Vec3(0));
  Vec3 transmittance{0.0f};  ///< of light that goes straight through
};

/// `outgoing`: unit, to where the light goes. An unlit or degenerate surface is black.
Vertex vertexAt(const scene::Scene& scene, const scene::Hit& hit, Direction outgoing, Materials materials);

}  // namespace relume::transport
