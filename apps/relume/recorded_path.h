// SPDX-License-Identifier: MIT
// A walk through a scene with the lamps that moved meanwhile: recorded by `relume view`, shown again by
// `relume render --path`.
#pragma once
#include <string>
#include <vector>

#include "relume/core/light.h"
#include "relume/picture/picture.h"

namespace relume::app {

struct PathFrame {
  picture::Viewpoint viewpoint;  ///< +Y up, perspective
  LightSet lights;
  std::vector<Vec3> moved;  ///< of things: metres from where they were put
};

/// {"frames": [{"eye", "target", "fov" in degrees, "lights" as in a light file, "moved"}]}. Lights that are
/// as in the frame before are left out.
std::string toJson(const std::vector<PathFrame>& frames);
/// Throws Error kInvalidJson, kInvalidValue naming `file`.
std::vector<PathFrame> parsePath(const std::string& text, const std::string& file);

}  // namespace relume::app
