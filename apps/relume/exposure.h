// SPDX-License-Identifier: MIT
// How bright a picture is shown when nobody says.
#pragma once
#include "relume/core/vec.h"
#include "relume/image/image.h"

namespace relume::app {

/// Stops for a lit picture: 0 where its middle can be seen as it is, else what brings it down, or up where
/// `raise` is set. glTF measures suns in lux and lamps in candela, so a sunny scene may be ten thousand times
/// too bright for a screen, and a room by one window is too dark. Black pixels and the background do not
/// count.
float chooseExposure(const image::Image& linear, Vec3 background, bool raise);

}  // namespace relume::app
