// SPDX-License-Identifier: MIT
// Where to stand in a scene that has no camera.
#pragma once
#include <optional>

#include "relume/picture/picture.h"

namespace relume::picture {

/// Bounds of what there is to see: of static instances, or of all when none is static. Never empty.
Box3 boundsToFrame(const scene::Scene& scene);
/// Looks along `forward` (unit) from where everything just fits into the picture.
Viewpoint fit(const scene::Scene& scene, const Box3& box, Direction forward, float aspect);
/// From outside, 25 degrees above the horizon, three-quarter: the four quarters are tried and the first that
/// sees the most front faces is taken.
Viewpoint frameFromOutside(const trace::Tracer& tracer, const Box3& box, float aspect);
/// Nothing unless the scene is an interior. A closed one is seen from the place inside that looks the
/// farthest over front faces; a stage, open to one side, from that side; a doll's house, open above, from
/// above.
std::optional<Viewpoint> frameInterior(const trace::Tracer& tracer, const Box3& box, float aspect);

}  // namespace relume::picture
