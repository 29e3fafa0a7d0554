// SPDX-License-Identifier: MIT
// What a camera sees of the surfaces: depth first, so that each place is shaded once, then the solid ones,
// then the translucent ones from far to near by object.
#pragma once
#include <compare>
#include <map>
#include <string>

#include "gl_objects.h"
#include "gpu_scene.h"
#include "pass_timer.h"
#include "relume/render/renderer.h"
#include "shadow_maps.h"

namespace relume::render {

/// Where from, and through what.
struct Eye {
  Mat4 clip_from_world{1.0f};  ///< depth 1 is near, 0 far
  Point position{0.0f};
  Direction forward{0, 0, -1};
  bool orthographic = false;
};

class DirectionLight;

/// What lies on the atlas; white where there is nothing.
struct SurfaceTextures {
  const Texture &value, &label, &bent, &obscurance;
  bool has_obscurance = false;
  const DirectionLight* directions = nullptr;  ///< instead of the value, in kLightmap
};

class DynamicObjects;

class SurfacePass {
 public:
  SurfacePass();
  /// Into the framebuffer and viewport that are set, over what was cleared there. Lights are bound (binding
  /// 1), and so are objects where there are some.
  void draw(const FrameSettings& frame, const GpuScene& scene, const ShadowMaps& shadows, const Eye& eye,
            const SurfaceTextures& textures, DynamicObjects* objects, PassTimer& timer);
  /// The standing world for a cube map about something that moves: radiance, and in alpha the inverse of the
  /// distance; without what is translucent.
  void drawSurroundings(const FrameSettings& frame, const GpuScene& scene, const ShadowMaps& shadows,
                        const Eye& eye, const SurfaceTextures& textures);
  Vec3 without_label{0.2f};

 private:
  /// Programs that cost what they show; made when they are first asked for.
  struct Variant {
    View view = View::kRelit;
    bool full = false, relief = false;
    ObjectLight object_light = ObjectLight::kNone;  ///< of an object's surfaces
    bool near_objects = false;                      ///< objects may hide light from it
    bool surroundings = false;
    int directions = 0;  ///< of a baked surface's light; 0: it has none
    Gloss gloss = Gloss::kNone;
    auto operator<=>(const Variant&) const = default;
  };
  const Program& programOf(const Variant& variant);
  void bind(const SurfaceTextures& textures) const;

  std::map<Variant, Program> programs_;
  Program depth_only_;
  Texture reflected_;
};

}  // namespace relume::render
