// SPDX-License-Identifier: MIT
// Pictures by OpenGL: what `relume render --renderer gl` does instead of rays.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "files.h"
#include "objects.h"
#include "recorded_path.h"
#include "relume/picture/picture.h"
#include "relume/render/renderer.h"

namespace relume::app {

/// Whether the bake is lit by lamps that move and its light follows them on the device: of a lightpath. Of
/// other transfer the run-time's irradiance is shown.
bool followsLamps(const Opened& opened, const std::string& layer);

/// The view of the same name.
render::View viewFor(picture::View view);
render::Camera cameraOf(const picture::Viewpoint& viewpoint);

/// Gives the renderer what the view shows of the bake. Throws as picture::render.
void showOnAtlas(render::Renderer& renderer, const scene::Scene& scene, const asset::Asset* asset,
                 picture::View view, const std::string& layer);

/// What comes on top of the pictures of rays.
struct GlExtras {
  bool full_materials = false;  ///< glTF's lobes, normal maps, and relief:
  bool relief_steps = true, relief_shadows = true;
  float small_scale = 1;
  std::vector<Group> objects;
  render::ObjectLight object_light = render::ObjectLight::kCube;
};

/// "cube", "probes" or "none".
render::ObjectLight objectLightOf(const std::string& name);

/// Whether light of this layer leaves at probes.
bool isProbeLayer(const asset::Layer& layer);

/// Tells the renderer of objects, and of the bake's probes where they are to light them. Throws Error
/// kNoSuchLayer without probes.
void addObjects(render::Renderer& renderer, const scene::Scene& scene, const asset::Asset* asset,
                const std::vector<Group>& groups, render::ObjectLight light);

/// Pictures of a recorded path, one after the other, each handed to `take` with its number from 0 on.
void glPictures(const scene::Scene& scene, const asset::Asset* asset, const std::vector<PathFrame>& path,
                const picture::PictureOptions& options, const GlExtras& extras,
                const std::function<void(std::size_t, const image::Image&)>& take);

/// The same frames drawn as the window draws them, none read back: what the device took for each pass, as a
/// text.
std::string timesOfPath(const scene::Scene& scene, const asset::Asset* asset,
                        const std::vector<PathFrame>& path, const picture::PictureOptions& options,
                        const GlExtras& extras);

/// The picture that picture::render makes, without a window, and with extras. Throws as picture::render, and
/// Error kUnsupported where there is no OpenGL.
image::Image glPicture(const scene::Scene& scene, const asset::Asset* asset,
                       const picture::Viewpoint& viewpoint, const picture::PictureOptions& options,
                       const GlExtras& extras);

}  // namespace relume::app
