// SPDX-License-Identifier: MIT
// Path-traced pictures: what `relume render --mode reference` does beyond other pictures.
#pragma once
#include <string>

#include "relume/picture/picture.h"
#include "relume/transport/reference.h"

namespace relume::app {

/// Gives the scene the lights and the environment of a light file, or keeps its own lights when `lights_file`
/// is empty; `ambient` (as typed; empty: none) makes a constant environment of that irradiance where the file
/// has none. A scene in which nothing shines gets a white sky, and a warning says so.
void lightScene(scene::Scene& scene, const std::string& lights_file, const std::string& ambient);

/// Linear radiance. Prints how many paths it took and what error they leave.
image::Image referencePicture(const transport::Reference& reference, const picture::Viewpoint& viewpoint,
                              IVec2 size, const transport::ReferenceOptions& options, Progress& progress);

}  // namespace relume::app
