// SPDX-License-Identifier: MIT
// Pictures of a scene and its bake, by rays on the CPU: what `relume render --renderer cpu` shows.
#pragma once
#include <string>

#include "relume/asset/asset.h"
#include "relume/core/light.h"
#include "relume/core/progress.h"
#include "relume/image/image.h"
#include "relume/scene/scene.h"
#include "relume/trace/tracer.h"

namespace relume::picture {

enum class View : std::uint8_t {
  kObscurance,  ///< ambient light times the obscurance (or spectral) layer times albedo ([IKSZ03] 4)
  kOcclusion,   ///< the layer's value alone, on white surfaces
  kLit,         ///< [IKSZ03] equation 5: ambient and all lights, with ray-traced shadows
  kAlbedo,
  kNormal,
  kBentNormal,
  kTexels,      ///< checkerboard of the atlas texels over the layer's value
  kCharts,      ///< a colour for each chart
  kValidity,    ///< invalid (buried) texels in red
};
const char* name(View view);

struct Viewpoint {
  Mat4 world_from_camera{1.0f};  ///< looks along -z, +y up
  float vertical_fov = 0.8f;     ///< radians
};
/// A viewpoint that looks from eye to target.
Viewpoint lookAt(Point eye, Point target, float vertical_fov);
/// The scene's camera of that index, or a framing of the whole scene when it has none: for a closed interior a place inside near a
/// corner looking across it, otherwise from outside. Throws Error kUsage for an index that is not there.
Viewpoint defaultViewpoint(const trace::Tracer& tracer, int camera);

struct PictureOptions {
  int width = 960, height = 540;
  int samples = 16;              ///< per pixel, stratified, tent filter of one pixel
  View view = View::kObscurance;
  std::string layer;             ///< name of the layer to show; empty: the first that fits the view
  Irradiance ambient{kPi};       ///< I_A; pi makes an unoccluded white surface radiance 1
  float beta = 0.1f;
  LightSet lights;               ///< world space
  Vec3 background{0.0f};         ///< linear
};

/// Linear radiance (or the view's own colours), RGB. `asset` may be null for views that need no bake; otherwise the scene must be
/// the baked file's own. Throws Error kNoSuchLayer when the view needs a layer that is not there.
image::Image render(const trace::Tracer& tracer, const asset::Asset* asset, const Viewpoint& viewpoint,
                    const PictureOptions& options, Progress& progress);

}  // namespace relume::picture
