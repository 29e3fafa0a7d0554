// SPDX-License-Identifier: MIT
#include "surface_pass.h"

#include <algorithm>
#include <set>
#include <vector>

#include "direction_light.h"
#include "dynamic_objects.h"

namespace relume::render {
namespace {

// Units of shaders/surface.frag.glsl.
constexpr GLuint kValueUnit = 4, kLabelUnit = 5, kBentUnit = 6, kReflectedUnit = 7, kObscuranceUnit = 10;
constexpr int kReflectedSize = 32;

Texture reflectedTable() {
  Texture table = Texture::make2d(GL_RG32F, {kReflectedSize, kReflectedSize});
  table.plain(true);
  const Program program = Program::compute("reflected.comp.glsl");
  glBindImageTexture(0, table.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RG32F);
  program.use();
  glDispatchCompute(kReflectedSize / 8, kReflectedSize / 8, 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  return table;
}

void setFrame(const Program& surface, const FrameSettings& frame, const Eye& eye, bool obscurance,
              Vec3 without_label) {
  const bool transfer = frame.view == View::kRelit || frame.view == View::kIndirect;
  surface.set("u_clip_from_world", eye.clip_from_world);
  surface.set("u_light_count", static_cast<int>(frame.lights.size()));
  surface.set("u_eye", eye.position);
  surface.set("u_forward", eye.forward);
  surface.set("u_orthographic", eye.orthographic ? 1u : 0u);
  surface.set("u_ambient", frame.ambient.rgb);
  surface.set("u_beta", frame.beta);
  surface.set("u_without_label", without_label);
  surface.set("u_direct_gain", frame.direct_gain);
  surface.set("u_indirect_gain", frame.indirect_gain);
  surface.set("u_obscurance_gain", obscurance && transfer ? frame.obscurance_gain : 0.0f);
  surface.set("u_bounce_gain", obscurance && transfer ? frame.bounce_gain : 0.0f);
  surface.set("u_small_scale_gain", frame.small_scale_gain);
  surface.set("u_relief_steps", frame.relief_steps ? 1u : 0u);
  surface.set("u_relief_shadows", frame.relief_shadows ? 1u : 0u);
}

}  // namespace

SurfacePass::SurfacePass()
    : depth_only_(Program::draw("surface.vert.glsl", "depth.frag.glsl")), reflected_(reflectedTable()) {}

const Program& SurfacePass::programOf(const Variant& variant) {
  Program& program = programs_[variant];
  if (!program)
    program =
        Program::draw("surface.vert.glsl", "surface.frag.glsl",
                      "#define VIEW " + std::to_string(static_cast<int>(variant.view)) + "\n#define FULL " +
                          (variant.full ? "1u" : "0u") + "\n#define RELIEF " + (variant.relief ? "1" : "0") +
                          "\n#define OBJECT_LIGHT " + std::to_string(static_cast<int>(variant.object_light)) +
                          "\n#define NEAR_OBJECTS " + (variant.near_objects ? "1" : "0") +
                          "\n#define SURROUNDINGS " + (variant.surroundings ? "1" : "0") +
                          "\n#define DIRECTIONS " + std::to_string(variant.directions) + "\n#define GLOSS " +
                          std::to_string(static_cast<int>(variant.gloss)) + "\n");
  return program;
}

void SurfacePass::bind(const SurfaceTextures& textures) const {
  textures.value.bind(kValueUnit);
  textures.label.bind(kLabelUnit);
  textures.bent.bind(kBentUnit);
  textures.obscurance.bind(kObscuranceUnit);
  reflected_.bind(kReflectedUnit);
}

void SurfacePass::drawSurroundings(const FrameSettings& frame, const GpuScene& scene,
                                   const ShadowMaps& shadows, const Eye& eye,
                                   const SurfaceTextures& textures) {
  const GLfloat clear[4] = {frame.background.x, frame.background.y, frame.background.z, 0};
  constexpr GLfloat kFar = 0.0f;
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_COLOR, 0, clear);
  glClearBufferfv(GL_DEPTH, 0, &kFar);
  scene.bind();
  bind(textures);
  const Program& surface = programOf({.view = frame.view, .surroundings = true});
  shadows.bind(surface);
  setFrame(surface, frame, eye, textures.has_obscurance, without_label);
  surface.use();
  for (const GpuScene::Drawn& d : scene.drawn()) {
    if (d.dynamic || d.translucent || !mayBeSeen(d.box, eye.clip_from_world)) continue;
    surface.set("u_page", d.page);
    surface.set("u_has_tangents", d.tangents ? 1u : 0u);
    surface.set("u_mirror", d.mirrored ? -1.0f : 1.0f);
    scene.draw(d, surface, true);
  }
}

void SurfacePass::draw(const FrameSettings& frame, const GpuScene& scene, const ShadowMaps& shadows,
                       const Eye& eye, const SurfaceTextures& textures, DynamicObjects* objects,
                       PassTimer& timer) {
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  scene.bind();
  std::vector<const GpuScene::Drawn*> solid, clear_ones;
  for (const GpuScene::Drawn& d : scene.drawn())
    if (mayBeSeen(d.box, eye.clip_from_world)) (d.translucent ? clear_ones : solid).push_back(&d);
  std::stable_sort(clear_ones.begin(), clear_ones.end(), [&](const auto* a, const auto* b) {
    return glm::distance(a->box.centre(), eye.position) > glm::distance(b->box.centre(), eye.position);
  });
  {
    const TimedPass pass(timer, "depth");
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    depth_only_.use();
    depth_only_.set("u_clip_from_world", eye.clip_from_world);
    for (const GpuScene::Drawn* d : solid) scene.draw(*d, depth_only_, false);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  const TimedPass pass(timer, "surfaces");
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_FALSE);
  bind(textures);
  if (objects) objects->bind();
  const bool lit = frame.view == View::kRelit || frame.view == View::kIndirect;
  const bool by_direction = textures.directions && frame.view == View::kLightmap;
  if (by_direction) textures.directions->bind();
  const bool relief =
      frame.full_materials && (frame.relief_steps || frame.relief_shadows || frame.small_scale_gain > 0);
  std::set<const Program*> ready;  // whose uniforms are those of this frame
  const Program* current = nullptr;
  const auto draw = [&](const GpuScene::Drawn& d) {
    const int object = objects && lit && d.dynamic ? objects->objectOf(d.instance) : -1;
    const Program& surface =
        programOf({.view = frame.view,
                   .full = frame.full_materials,
                   .relief = relief && scene.hasRelief(d),
                   .object_light = object >= 0 ? frame.object_light : ObjectLight::kNone,
                   .near_objects = objects && lit && !d.dynamic && frame.object_occlusion_gain > 0,
                   .directions = by_direction && d.page >= 0 ? textures.directions->directions() : 0,
                   .gloss = by_direction && d.page >= 0 ? frame.gloss : Gloss::kNone});
    if (ready.insert(&surface).second) {
      shadows.bind(surface);
      setFrame(surface, frame, eye, textures.has_obscurance, without_label);
      surface.set("u_object_count", objects ? static_cast<int>(objects->size()) : 0);
      surface.set("u_object_occlusion_gain", frame.object_occlusion_gain);
    }
    if (current != &surface) surface.use(), current = &surface;
    surface.set("u_page", d.page);
    surface.set("u_object", object);
    surface.set("u_has_tangents", d.tangents ? 1u : 0u);
    surface.set("u_mirror", d.mirrored ? -1.0f : 1.0f);
    scene.draw(d, surface, true);
  };
  for (const GpuScene::Drawn* d : solid) draw(*d);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  for (const GpuScene::Drawn* d : clear_ones) draw(*d);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
}

}  // namespace relume::render
