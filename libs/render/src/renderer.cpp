// SPDX-License-Identifier: MIT
// A frame: shadow maps of lights that moved, their light at entries, the product and its texels where
// anything changed, depth, surfaces, and translucent ones from far to near.
#include "relume/render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "atlas_textures.h"
#include "camera_matrix.h"
#include "direction_light.h"
#include "dynamic_objects.h"
#include "gl_objects.h"
#include "gpu_lights.h"
#include "gpu_scene.h"
#include "pass_timer.h"
#include "probe_light.h"
#include "relighting.h"
#include "relume/core/sampling.h"
#include "relume/render/context.h"
#include "shadow_maps.h"
#include "surface_pass.h"

namespace relume::render {
namespace {

constexpr int kThumbnailWidth = 32, kThumbnailHeight = 18;

/// u in [0, 1) to the tent density 1 - |x| on [-1, 1].
float toTent(float u) { return u < 0.5f ? std::sqrt(2.0f * u) - 1.0f : 1.0f - std::sqrt(2.0f - 2.0f * u); }

/// Places of samples about a pixel's centre, of which their mean is. One sample is the centre.
std::vector<Vec2> tentOffsets(int samples) {
  std::vector<Vec2> offsets;
  Vec2 sum(0.0f);
  for (int s = 0; s < samples; ++s) {
    const Vec2 u = sobol2(static_cast<std::uint32_t>(s), 0x9e3779b9u);
    offsets.emplace_back(toTent(u.x), toTent(u.y));
    sum += offsets.back();
  }
  for (Vec2& offset : offsets) offset -= sum / static_cast<float>(samples);
  return offsets;
}

bool hasArea(const Light& light) { return light.kind == Light::Kind::kArea && light.area > 0; }

}  // namespace

struct Renderer::Impl {
  Impl(const scene::Scene& s, const ShadowOptions& options)
      : scene(s),
        shadows(options),
        tone(Program::draw("fullscreen.vert.glsl", "tone.frag.glsl")),
        fxaa(Program::draw("fullscreen.vert.glsl", "fxaa.frag.glsl")),
        white(whiteArray()),
        none(VertexArray::make()),
        lights_buffer(0) {}

  /// Which of the frame's lights changed, with shadow maps drawn for them.
  std::vector<std::uint8_t> updateLights(const FrameSettings& frame);
  void relight(std::span<const std::uint8_t> changed);
  void lightObjects(const FrameSettings& frame, std::span<const std::uint8_t> changed);
  SurfaceTextures textures(View view) const {
    return {values(view),
            label ? label : white,
            bent ? bent : white,
            obscurance ? obscurance : white,
            static_cast<bool>(obscurance),
            directions ? &*directions : nullptr};
  }
  void drawSurfaces(const FrameSettings& frame);
  void setSize(IVec2 size);
  const Texture& values(View view) const {
    const bool relit = view == View::kRelit || view == View::kIndirect;
    return relit && relighting ? relighting->pages() : value ? value : white;
  }

  GpuScene scene;
  ShadowMaps shadows;
  SurfacePass surfaces;
  Program tone, fxaa;
  Texture white, value, label, bent, obscurance;
  std::optional<TexelPass> irradiance;
  std::optional<Relighting> relighting;
  std::optional<ProbeLight> probes;
  std::optional<DirectionLight> directions;
  DynamicObjects objects;
  std::vector<Mat4> at_start;  ///< world_from_local by drawn instance, when its object was added
  bool objects_moved = false;
  ObjectLight objects_lit_by = ObjectLight::kNone;
  VertexArray none;
  Buffer lights_buffer;
  std::size_t lights_room = 0;
  LightSet shown;  ///< whose shadows and factors are current
  Vec2 shown_sample{-1};
  bool stale = true;  ///< all shadows and factors
  bool strength_changed = true;
  IVec2 size{0, 0};
  Texture colour, depth, toned, small;
  Framebuffer target, toned_target, small_target;
  PassTimer timer;
};

std::vector<std::uint8_t> Renderer::Impl::updateLights(const FrameSettings& frame) {
  bool all_anew = false;
  const std::vector<int> layers = shadows.layers(frame.lights, all_anew);
  all_anew |= stale || shown.size() != frame.lights.size();
  if (relighting && frame.lights.size() > lights_room) all_anew = true;
  std::vector<std::uint8_t> changed(frame.lights.size(), 1);
  strength_changed = all_anew;
  std::vector<GpuLight> packed;
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    const Light& light = frame.lights[i];
    packed.push_back(toGpu(light, layers[i], pointOn(light, frame.area_sample)));
    if (all_anew) continue;
    changed[i] = !sameButStrength(light, shown[i]) || (hasArea(light) && frame.area_sample != shown_sample);
    strength_changed |= changed[i] || light.colour * light.intensity != shown[i].colour * shown[i].intensity;
  }
  if (packed.size() > lights_room || !lights_buffer.bytes()) {
    lights_room = std::max<std::size_t>(packed.size(), 8);
    lights_buffer = Buffer(lights_room * sizeof(GpuLight));
  }
  lights_buffer.write(0, packed.size() * sizeof(GpuLight), packed.data());
  const TimedPass pass(timer, "shadows");
  for (std::size_t i = 0; i < frame.lights.size(); ++i)
    if (changed[i])
      shadows.draw(scene, frame.lights[i], pointOn(frame.lights[i], frame.area_sample), layers[i]);
  shown = frame.lights;
  shown_sample = frame.area_sample;
  stale = false;
  return changed;
}

void Renderer::Impl::relight(std::span<const std::uint8_t> changed) {
  if (!relighting || !strength_changed) return;
  lights_buffer.bindStorage(1);
  shadows.bind(relighting->received());
  relighting->run(changed, timer);
}

void Renderer::Impl::lightObjects(const FrameSettings& frame, std::span<const std::uint8_t> changed) {
  const bool lit = frame.view == View::kRelit || frame.view == View::kIndirect;
  if (objects.empty() || !lit) return;
  const bool anew = strength_changed || frame.object_light != objects_lit_by;
  objects_lit_by = frame.object_light;
  if (frame.object_light == ObjectLight::kCube) {
    const TimedPass pass(timer, "objects");
    FrameSettings around = frame;
    around.view = View::kRelit;
    around.full_materials = false;
    lights_buffer.bindStorage(1);
    objects.refreshCubes(anew, [&](const Eye& eye) {
      surfaces.drawSurroundings(around, scene, shadows, eye, textures(View::kRelit));
    });
  } else if (frame.object_light == ObjectLight::kProbes && probes) {
    if (anew) {
      lights_buffer.bindStorage(1);
      probes->relight(changed, shadows, timer);
    }
    if (anew || objects_moved)
      objects.refreshProbes([&](Point p, Normal n) { return probes->irradiance(p, n); });
  }
  objects_moved = false;
}

void Renderer::Impl::setSize(IVec2 wanted) {
  if (wanted == size) return;
  size = wanted;
  colour = Texture::make2d(GL_RGBA32F, size);
  colour.plain(true);
  depth = Texture::make2d(GL_DEPTH_COMPONENT32F, size);
  target = Framebuffer::make();
  target.attach(GL_COLOR_ATTACHMENT0, colour);
  target.attach(GL_DEPTH_ATTACHMENT, depth);
  toned = {};
}

void Renderer::Impl::drawSurfaces(const FrameSettings& frame) {
  setSize(frame.size);
  glBindFramebuffer(GL_FRAMEBUFFER, target.name());
  glViewport(0, 0, size.x, size.y);
  const GLfloat clear[4] = {frame.background.x, frame.background.y, frame.background.z, 1};
  const GLfloat far = 0.0f;
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_COLOR, 0, clear);
  glClearBufferfv(GL_DEPTH, 0, &far);
  const Vec2 extent(static_cast<float>(size.x), static_cast<float>(size.y));
  // A sample to the right of the centre sees what a picture moved to the left shows there.
  const Eye eye{.clip_from_world = clipFromWorld(frame.camera, scene.bounds(), extent.x / extent.y,
                                                 Vec2(-2.0f, 2.0f) * frame.jitter / extent),
                .position = Point(frame.camera.world_from_camera[3]),
                .forward = -glm::normalize(Vec3(frame.camera.world_from_camera[2])),
                .orthographic = frame.camera.ortho_height > 0};
  lights_buffer.bindStorage(1);
  DynamicObjects* things = objects.empty() ? nullptr : &objects;
  surfaces.draw(frame, scene, shadows, eye, textures(frame.view), things, timer);
  if (!(frame.split > 0)) return;
  FrameSettings left = frame;
  left.view = frame.split_view;
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, static_cast<GLsizei>(std::lround(frame.split * extent.x)), size.y);
  glClearBufferfv(GL_COLOR, 0, clear);
  glClearBufferfv(GL_DEPTH, 0, &far);
  surfaces.draw(left, scene, shadows, eye, textures(left.view), things, timer);
  glDisable(GL_SCISSOR_TEST);
}

Renderer::Renderer(const scene::Scene& scene, const ShadowOptions& shadows) {
  requireOpenGl();
  impl_ = std::make_unique<Impl>(scene, shadows);
}

Renderer::~Renderer() = default;

void Renderer::setValues(const asset::AtlasTable& atlas, const asset::Plane& plane) {
  impl_->value = planeTexture(atlas, plane);
  impl_->directions.reset();
}
void Renderer::setDirections(const asset::Asset& asset, const asset::Layer& layer) {
  impl_->directions.emplace(asset::directionMapsOf(layer, asset.atlas), asset.atlas);
}
void Renderer::setBent(const asset::AtlasTable& atlas, const asset::Plane& plane) {
  impl_->bent = planeTexture(atlas, plane);
}
void Renderer::setObscurance(const asset::AtlasTable& atlas, const asset::Plane& plane) {
  impl_->obscurance = planeTexture(atlas, plane);
}
void Renderer::setLabels(const asset::AtlasTable& atlas, std::span<const Vec3> colours, Vec3 elsewhere) {
  impl_->surfaces.without_label = elsewhere;
  impl_->label = labelTexture(atlas, colours);
}
void Renderer::setIrradiance(const asset::AtlasTable& atlas, std::span<const Irradiance> texels) {
  impl_->relighting.reset();
  asset::Plane plane{.name = "value", .channels = 3, .storage = asset::Storage::kFloat32, .values = {}};
  plane.values.assign(3 * atlas.pageTexels(), 0.0f);
  for (std::size_t i = 0; i < atlas.texel.size(); ++i)
    for (int c = 0; c < 3; ++c)
      plane.values[3 * atlas.texel[i] + static_cast<std::size_t>(c)] = texels[i].rgb[c];
  impl_->value = planeTexture(atlas, plane);
}
void Renderer::setTransfer(const asset::Asset& asset, const asset::Layer& layer) {
  impl_->relighting.reset();
  impl_->relighting.emplace(asset, layer);
  impl_->stale = true;
}

void Renderer::setManySamples(bool many) {
  impl_->scene.setFilter(many ? TextureFilter::kBilinear : TextureFilter::kMipmaps);
}

void Renderer::place(std::uint32_t instance, const Mat4& world_from_local) {
  for (std::size_t i = 0; i < impl_->scene.drawn().size(); ++i)
    if (impl_->scene.drawn()[i].instance == instance)
      impl_->scene.place(i, world_from_local), impl_->stale = true;
}

std::size_t Renderer::addObject(const Object& object) {
  Impl& r = *impl_;
  const std::size_t added = r.objects.add(object, r.scene);
  r.at_start.resize(r.scene.drawn().size());
  for (std::size_t i = 0; i < r.at_start.size(); ++i)
    if (r.objects.objectOf(r.scene.drawn()[i].instance) == static_cast<int>(added))
      r.at_start[i] = r.scene.drawn()[i].world_from_local;
  r.stale = r.objects_moved = true;
  return added;
}

void Renderer::placeObject(std::size_t object, const Mat4& world_from_start) {
  Impl& r = *impl_;
  if (r.objects.placeOf(object) == world_from_start) return;
  for (std::size_t i = 0; i < r.at_start.size(); ++i)
    if (r.objects.objectOf(r.scene.drawn()[i].instance) == static_cast<int>(object))
      r.scene.place(i, world_from_start * r.at_start[i]);
  r.objects.place(object, world_from_start, r.scene);
  r.stale = r.objects_moved = true;
}

void Renderer::setProbes(const asset::Asset& asset, const asset::Layer& layer) {
  impl_->probes.reset();
  impl_->probes.emplace(asset, layer);
  impl_->stale = true;
}

void Renderer::draw(const FrameSettings& frame) {
  impl_->timer.beginFrame();
  const std::vector<std::uint8_t> changed = impl_->updateLights(frame);
  impl_->relight(changed);
  impl_->lightObjects(frame, changed);
  impl_->drawSurfaces(frame);
}

image::Image Renderer::read() const {
  const IVec2 size = impl_->size;
  image::Image picture(size.x, size.y, 3), flipped(size.x, size.y, 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(impl_->colour.name(), 0, GL_RGB, GL_FLOAT,
                    static_cast<GLsizei>(flipped.data.size() * sizeof(float)), flipped.data.data());
  const auto row = static_cast<std::ptrdiff_t>(3 * size.x);
  for (int y = 0; y < size.y; ++y)
    std::copy_n(flipped.data.begin() + row * (size.y - 1 - y), row, picture.data.begin() + row * y);
  return picture;
}

image::Image Renderer::picture(FrameSettings frame, int samples) {
  setManySamples(samples > 1);
  image::Image sum(frame.size.x, frame.size.y, 3);
  const std::vector<Vec2> offsets = tentOffsets(samples);
  for (int s = 0; s < samples; ++s) {
    frame.jitter = offsets[static_cast<std::size_t>(s)];
    if (samples > 1) frame.area_sample = sobol2(static_cast<std::uint32_t>(s), 0x51ed270bu);
    draw(frame);
    const image::Image one = read();
    for (std::size_t i = 0; i < sum.data.size(); ++i) sum.data[i] += one.data[i];
  }
  for (float& v : sum.data) v /= static_cast<float>(samples);
  return sum;
}

void Renderer::present(const Present& how) {
  Impl& r = *impl_;
  if (!r.toned) {
    r.toned = Texture::make2d(GL_RGBA8, r.size);
    r.toned.plain(true);
    r.toned_target = Framebuffer::make();
    r.toned_target.attach(GL_COLOR_ATTACHMENT0, r.toned);
  }
  const TimedPass pass(r.timer, "tone");
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindVertexArray(r.none.name());
  glBindFramebuffer(GL_FRAMEBUFFER, r.toned_target.name());
  glViewport(0, 0, r.size.x, r.size.y);
  r.colour.bind(0);
  r.tone.use();
  r.tone.set("u_scale", std::exp2(how.exposure_stops));
  r.tone.set("u_filmic", how.filmic ? 1u : 0u);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindFramebuffer(GL_FRAMEBUFFER, how.framebuffer);
  glViewport(how.origin.x, how.origin.y, r.size.x, r.size.y);
  r.toned.bind(0);
  r.fxaa.use();
  r.fxaa.set("u_pixel", 1.0f / Vec2(r.size));
  r.fxaa.set("u_smooth", how.fxaa ? 1u : 0u);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

image::Image Renderer::thumbnail() {
  Impl& r = *impl_;
  if (!r.small) {
    r.small = Texture::make2d(GL_RGBA32F, {kThumbnailWidth, kThumbnailHeight});
    r.small_target = Framebuffer::make();
    r.small_target.attach(GL_COLOR_ATTACHMENT0, r.small);
  }
  glBlitNamedFramebuffer(r.target.name(), r.small_target.name(), 0, 0, r.size.x, r.size.y, 0, 0,
                         kThumbnailWidth, kThumbnailHeight, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  image::Image out(kThumbnailWidth, kThumbnailHeight, 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(r.small.name(), 0, GL_RGB, GL_FLOAT,
                    static_cast<GLsizei>(out.data.size() * sizeof(float)), out.data.data());
  return out;
}

std::vector<PassTime> Renderer::times() const { return impl_->timer.times(); }
std::vector<Irradiance> Renderer::readEntries() const {
  return impl_->relighting ? impl_->relighting->readEntries() : std::vector<Irradiance>();
}
std::vector<Irradiance> Renderer::readTexels() const {
  return impl_->relighting ? impl_->relighting->readTexels() : std::vector<Irradiance>();
}
std::size_t Renderer::sampleBytes() const { return impl_->relighting ? impl_->relighting->sampleBytes() : 0; }

}  // namespace relume::render
