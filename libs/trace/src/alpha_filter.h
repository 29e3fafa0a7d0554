// SPDX-License-Identifier: MIT
// Lets rays pass through what is not opaque.
#pragma once
#include "embree_api.h"
#include "relume/scene/scene.h"

namespace relume::trace {

/// What lets rays through.
enum class Passing { kAlphaAndTransmission, kAlpha };

/// Whether rays may pass through some of the mesh, so that each of its hits must be looked at.
bool needsAlphaFilter(const scene::Scene& scene, const scene::Mesh& mesh, Passing passing);

/// Filter of both kinds of query; the geometry's user pointer is the scene::Scene. A hit stays with the
/// probability of its opacity: the number it is compared with is a hash of (seed of the ray, instance,
/// triangle), so that the same ray always decides alike and, over seeds, hits on different triangles are
/// independent.
template <Passing kPassing>
void alphaFilter(const RTCFilterFunctionNArguments* arguments);

}  // namespace relume::trace
