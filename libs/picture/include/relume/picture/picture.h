// SPDX-License-Identifier: MIT
// Pictures of a scene and its bake, by rays on the CPU: what `relume render --renderer cpu` shows.
// Based on:
//   [LPM] Umenhoffer, Szirmay-Kalos, Szecsi, Toth. Global Illumination in Games with Multi-scale PRT, 2009.
#pragma once
#include <string>

#include "relume/asset/asset.h"
#include "relume/core/light.h"
#include "relume/core/progress.h"
#include "relume/image/image.h"
#include "relume/scene/environment.h"
#include "relume/scene/scene.h"
#include "relume/trace/tracer.h"

namespace relume::picture {

enum class View : std::uint8_t {
  kObscurance,  ///< ambient light times the obscurance (or spectral) layer times albedo ([IKSZ03] 4)
  kOcclusion,   ///< the layer's value alone, on white surfaces
  kLit,         ///< [IKSZ03] equation 5: ambient and all lights, with ray-traced shadows
  kLightmap,    ///< a lightmap's irradiance on the surfaces' colours, with what they emit
  kRelit,       ///< a layer of transfer: relit indirect irradiance and all lights, with ray-traced shadows
  kIndirect,    ///< the same without light that comes straight from lamps
  kAlbedo,      ///< diffuse albedo; metals are black
  kNormal,      ///< world-space shading normal n as (n + 1) / 2
  kBentNormal,  ///< the layer's bent normal, likewise
  kTexels,      ///< checkerboard of the atlas texels over the layer's value; hue changes every 8 texels
  kCharts,      ///< a colour for each chart
  kValidity,    ///< valid texels grey, invalid (buried) ones red, surfaces without a texel magenta
};
const char* name(View view);

struct Viewpoint {
  Mat4 world_from_camera{1.0f};  ///< looks along -z, +y up
  float vertical_fov = 0.8f;     ///< radians
  float ortho_height = 0.0f;     ///< metres that the picture's height spans; 0: perspective
};
/// A viewpoint that looks from eye to target, +Y up (for a vertical look -Z is up).
Viewpoint lookAt(Point eye, Point target, float vertical_fov);
/// Frames a scene without asking its cameras: a closed interior from a place inside looking across it, a box
/// with an open side from that side, anything else from outside and above with all of it in the picture.
/// `aspect` is width / height of the picture to come. Deterministic.
Viewpoint frameScene(const trace::Tracer& tracer, float aspect = 16.0f / 9.0f);
/// The scene's camera of that index; -1: its first one. Where the scene has no camera, both -1 and 0 frame
/// the scene. Throws Error kUsage for an index that is not there.
Viewpoint defaultViewpoint(const trace::Tracer& tracer, int camera, float aspect = 16.0f / 9.0f);

/// How surfaces reflect directional light (kLightmap of a layer that has it).
enum class Gloss : std::uint8_t {
  kNone,   ///< all as if diffusely, metals too
  kGgx,    ///< as materials say
  kPhong,  ///< the same with Phong's lobes
};

struct PictureOptions {
  int width = 960, height = 540;
  int samples = 16;  ///< per pixel, stratified, tent filter of one pixel's radius
  View view = View::kObscurance;
  std::string layer;        ///< name of the layer to show; empty: the first that fits the view
  Irradiance ambient{kPi};  ///< I_A; pi makes an unoccluded white surface radiance 1
  float beta = 0.1f;
  LightSet lights;                 ///< world space
  Vec3 background{0.0f};           ///< linear
  scene::Environment environment;  ///< seen instead of the background, where it is not dark
  Gloss gloss = Gloss::kGgx;
  /// Of kRelit and kIndirect, [LPM] section 10 with W an obscurance or spectral layer:
  /// indirect light becomes I (1 - obscurance + obscurance W) + bounce W E, E the direct irradiance.
  float obscurance = 0, bounce = 0;
  std::string obscurance_layer;  ///< whose W that is; empty: the first spectral, else obscurance layer
};

/// Whether a picture asks for W of an obscurance layer beside what its view shows.
bool weightsByObscurance(const PictureOptions& options);

/// Whether a layer holds transfer of light; a view of it wants its plane "value" filled with the irradiance
/// that the run time made of it.
bool isTransfer(const asset::Layer& layer);

/// Linear radiance (or the view's own colours), RGB. `asset` may be null for views that need no bake
/// (kAlbedo, kNormal); otherwise the scene must be the baked file's own. Surfaces without a bake (dynamic
/// instances) have W = 1 and, where lamps are shown, no light but the ambient one. Metals reflect as if
/// diffusely. Bits do not depend on the number of threads. Throws Error kNoSuchLayer when the view needs a
/// layer or plane that is not there, kMismatch when scene and asset do not belong together, kUsage for a size
/// or number of samples out of range.
image::Image render(const trace::Tracer& tracer, const asset::Asset* asset, const Viewpoint& viewpoint,
                    const PictureOptions& options, Progress& progress);

}  // namespace relume::picture
