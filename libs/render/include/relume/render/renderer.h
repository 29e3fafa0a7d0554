// SPDX-License-Identifier: MIT
// A scene and its bake drawn by OpenGL 4.5: shadow maps, light of entries, relighting and shading, all on the
// device. Based on:
//   [LPM] Umenhoffer, Szirmay-Kalos, Szecsi, Toth. Global Illumination in Games with Multi-scale PRT, section
//   10.
// Pictures are those of libs/picture, which rays make, but for the width of shadow edges; glossy lobes and
// normal maps come on top where they are asked for. Translucent surfaces are drawn from far to near by
// object, and throw shadows of as many points as they are opaque.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relume/asset/asset.h"
#include "relume/core/light.h"
#include "relume/image/image.h"
#include "relume/render/objects.h"
#include "relume/scene/scene.h"

namespace relume::render {

/// What is shown; formulas in shaders/surface.frag.glsl, which numbers them alike.
enum class View : std::uint8_t {
  kObscurance,  ///< ambient light times the value times albedo
  kOcclusion,   ///< the value alone
  kLit,         ///< ambient and all lights
  kLightmap,    ///< the value as irradiance on the surfaces' colours
  kRelit,       ///< relit irradiance and all lights
  kIndirect,    ///< relit irradiance alone
  kAlbedo,
  kNormal,
  kBentNormal,
  kTexels,  ///< the texels of the atlas over the value
  kLabels,  ///< colours of setLabels, e.g. charts
  kDirect,  ///< all lights, no indirect light
};

/// How surfaces reflect light that is known by direction (kLightmap after setDirections).
enum class Gloss : std::uint8_t { kNone, kGgx, kPhong };

struct Camera {
  Mat4 world_from_camera{1.0f};  ///< looks along -z, +y up; its scale counts for nothing
  float vertical_fov = 0.8f;     ///< radians
  float ortho_height = 0.0f;     ///< metres that the picture's height spans; 0: perspective
};

struct ShadowOptions {
  int cube_size = 512;    ///< texels along a side of a cube's face, at most; less where lights are many
  int plane_size = 2048;  ///< of a directional light's map
  float filter = 1.0f;    ///< width of the tent, texels; 0: none
  float bleeding = 0.2f;  ///< share of Chebyshev's bound that counts as dark, [0, 1)
  std::size_t most_bytes = std::size_t{384} << 20;
};

struct FrameSettings {
  IVec2 size{960, 540};
  Camera camera;
  View view = View::kRelit;
  LightSet lights;  ///< world
  /// Share of the width, from the left, that shows `split_view` instead.
  float split = 0.0f;
  View split_view = View::kDirect;
  Irradiance ambient{0.0f};  ///< beside the lights
  float beta = 0.1f;         ///< of View::kLit: share of every light that arrives everywhere
  Vec3 background{0.0f};     ///< linear
  Gloss gloss = Gloss::kGgx;
  bool full_materials = false;  ///< glTF's lobes and normal maps, else Lambert's alone
  float direct_gain = 1.0f, indirect_gain = 1.0f;
  /// [LPM] 10 with W of setObscurance: indirect light is I (1 - obscurance_gain + obscurance_gain W) +
  /// bounce_gain W E, E the direct irradiance.
  float obscurance_gain = 0.0f, bounce_gain = 0.0f;
  /// Height maps of materials (scene::Material), with full materials: relief by cone stepping, shadows that
  /// it throws on itself, and the share of W(alpha, gamma, h) ([LPM] 9) by which it darkens indirect light.
  bool relief_steps = true, relief_shadows = true;
  float small_scale_gain = 1.0f;
  /// In kRelit and kIndirect: indirect light on objects, and the share by which they hide that of others.
  ObjectLight object_light = ObjectLight::kCube;
  float object_occlusion_gain = 1.0f;
  Vec2 jitter{0.0f};             ///< pixels, from their centres
  Vec2 area_sample{0.5f, 0.5f};  ///< which point of area lights casts their shadows, [0, 1)^2
};

/// Seconds that the device took for each pass of the last frame whose times are known.
struct PassTime {
  std::string name;
  double seconds = 0;
};

class Renderer {
 public:
  /// A context of OpenGL 4.5 must be current, now and at every call. Keeps no reference to the scene. Throws
  /// Error kUnsupported, kOutOfMemory.
  explicit Renderer(const scene::Scene& scene, const ShadowOptions& shadows = {});
  ~Renderer();

  // What lies on the atlas; each replaces what was there before. Sizes are the atlas table's; planes have 1
  // or 3 channels (bent: 3) over all pages.
  void setValues(const asset::AtlasTable& atlas, const asset::Plane& plane);
  void setBent(const asset::AtlasTable& atlas, const asset::Plane& plane);
  void setObscurance(const asset::AtlasTable& atlas, const asset::Plane& plane);
  /// In the view kLightmap light comes from this layer, of kind `directional`, from now on; highlights move
  /// with the camera. Throws Error kCorruptAsset (asset/direction_maps.h).
  void setDirections(const asset::Asset& asset, const asset::Layer& layer);
  /// Colours by texel of the table, in [0, 1]; `elsewhere` is that of surfaces without a bake.
  void setLabels(const asset::AtlasTable& atlas, std::span<const Vec3> colours, Vec3 elsewhere);
  /// Irradiance by texel of the table.
  void setIrradiance(const asset::AtlasTable& atlas, std::span<const Irradiance> texels);
  /// In the views kRelit and kIndirect values come from relighting this layer from now on. Throws Error
  /// kMismatch, kCorruptAsset (asset/transfer.h), kUnsupported where the device cannot hold it.
  void setTransfer(const asset::Asset& asset, const asset::Layer& layer);

  /// One sample a pixel with mipmaps, or samples of many frames without (scene/scene.h looks textures up so).
  void setManySamples(bool many);
  /// Puts an instance of the scene elsewhere; shadows follow.
  void place(std::uint32_t instance, const Mat4& world_from_local);

  /// Instances of the scene that move together from now on, lit by the world about them. Throws Error kUsage
  /// for more than eight, or occlusion that is not of 16 cells a side.
  std::size_t addObject(const Object& object);
  /// Where an object stands, relative to where it was when it was added.
  void placeObject(std::size_t object, const Mat4& world_from_start);
  /// The layer whose probes light objects (ObjectLight::kProbes). Throws Error kMismatch for one without.
  void setProbes(const asset::Asset& asset, const asset::Layer& layer);

  void draw(const FrameSettings& frame);
  /// Linear radiance of the last frame; waits for the device. 3 channels, row 0 on top.
  image::Image read() const;
  /// The mean of `samples` frames over a tent of a pixel's radius and over the points of area lights.
  image::Image picture(FrameSettings frame, int samples);

  /// Shows the last frame in the framebuffer that is bound, `size` pixels from its lower left corner.
  struct Present {
    float exposure_stops = 0;
    bool filmic = true, fxaa = true;
    IVec2 origin{0, 0};
    unsigned framebuffer = 0;
  };
  void present(const Present& how);
  /// Linear radiance of about 32 x 18 places of the last frame, for choosing an exposure; waits.
  image::Image thumbnail();

  std::vector<PassTime> times() const;
  // For tests and statistics; wait for the device.
  std::vector<Irradiance> readEntries() const;
  std::vector<Irradiance> readTexels() const;
  std::size_t sampleBytes() const;  ///< of the transfer

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relume::render
