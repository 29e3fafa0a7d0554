// SPDX-License-Identifier: MIT
// Shadows by rays for the run-time, which has none of its own.
#pragma once
#include "relume/asset/asset.h"
#include "relume/core/light.h"
#include "relume/relight/obscurance.h"
#include "relume/trace/tracer.h"

namespace relume::app {

/// Visibility of each light from each covered texel: one ray, or 16 over the disk of an area light. Keeps
/// references.
relight::VisibilitySource tracedVisibility(const trace::Tracer& tracer, const asset::AtlasTable& atlas,
                                           const LightSet& lights);

}  // namespace relume::app
