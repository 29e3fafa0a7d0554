// SPDX-License-Identifier: MIT
// The window of `relume view`: a bake or a plain scene, walked through and lit by hand.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "relume/core/light.h"
#include "relume/core/vec.h"

namespace relume::app {

struct ViewerOptions {
  std::filesystem::path file;
  std::string lights;                ///< a light file; empty: the scene's lights
  std::string layer;                 ///< of transfer; empty: the first
  std::vector<std::string> objects;  ///< FILE.glb@x,y,z, put into the scene
  std::string object_light = "cube";
  int camera = -1;
  IVec2 size{1280, 720};
  int shadow_size = 0;     ///< texels along a cube's face; 0: by the device
  int frames = 0;          ///< ends after so many; 0: when the window is closed
  std::string screenshot;  ///< of the last frame of those; empty: none
  std::vector<std::string>
      show;            ///< from the start: split, entries, truth, help; panels: in the screenshot too
  std::string record;  ///< of those frames: a path for render --path; empty: none
  bool sweep = false;  ///< moves the first light while it runs, for measurements and tests
};

/// Runs until the window is closed. Throws Error kUnsupported where there is no display or no OpenGL 4.5, and
/// what opening files throws.
void runViewer(const ViewerOptions& options);

}  // namespace relume::app
