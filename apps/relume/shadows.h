// SPDX-License-Identifier: MIT
// Shadows by rays for the run-time, which has none of its own.
#pragma once
#include <span>

#include "relume/core/light.h"
#include "relume/relight/visibility.h"
#include "relume/trace/tracer.h"

namespace relume::app {

/// Visibility of each light from each point: one ray, or 16 all over an area light. Keeps references.
relight::VisibilitySource tracedVisibility(const trace::Tracer& tracer, std::span<const Point> points,
                                           std::span<const Normal> normals, const LightSet& lights);

}  // namespace relume::app
