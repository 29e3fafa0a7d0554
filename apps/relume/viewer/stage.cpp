// SPDX-License-Identifier: MIT
#include "viewer/stage.h"

#include <fmt/format.h>

#include <algorithm>

#include "exposure.h"
#include "gl_picture.h"
#include "lights.h"
#include "relit.h"
#include "relume/asset/transfer.h"
#include "relume/image/colour.h"
#include "relume/picture/baked_values.h"
#include "relume/render/context.h"
#include "relume/scene/merge.h"

namespace relume::app {
namespace {

using picture::View;

constexpr int kSoftwareShadows = 256, kDeviceShadows = 1024;
constexpr float kExposureStep = 0.15f;  // of the way, each frame

bool has(const asset::Asset* asset, auto fits) {
  return asset && std::any_of(asset->layers.begin(), asset->layers.end(), fits);
}

std::vector<StageView> viewsOf(const asset::Asset* asset) {
  const auto kind = [](const char* name) { return [=](const asset::Layer& l) { return l.kind == name; }; };
  std::vector<StageView> views;
  if (has(asset, kind("lightpath"))) {
    views.push_back({"relit: direct and indirect light", View::kRelit});
    views.push_back({"indirect light", View::kIndirect});
  }
  if (has(asset, kind("lightmap"))) views.push_back({"lightmap", View::kLightmap});
  const bool values =
      has(asset, kind("obscurance")) || has(asset, kind("spectral")) || has(asset, kind("ao"));
  if (values) {
    views.push_back({"lit: ambient light, obscurance and lamps", View::kLit});
    views.push_back({"obscurance under ambient light", View::kObscurance});
    views.push_back({"obscurance alone", View::kOcclusion});
    views.push_back({"texels of the atlas", View::kTexels});
  }
  if (asset) {
    views.push_back({"charts of the atlas", View::kCharts});
    views.push_back({"valid texels", View::kValidity});
  }
  views.push_back({"albedo", View::kAlbedo});
  views.push_back({"normals", View::kNormal});
  return views;
}

Light lampFor(const Box3& box) {
  Light lamp;
  lamp.name = "lamp";
  lamp.position = box.empty() ? Point(0, 2, 0) : box.centre();
  const float reach = box.empty() ? 4.0f : 0.25f * box.diagonal();
  lamp.intensity = 3.0f * reach * reach;
  return lamp;
}

}  // namespace

Stage::Stage(const ViewerOptions& options, const std::filesystem::path& file)
    : camera({}, 1), opened_(open(file, {.normal_maps = true})), layer_(options.layer) {
  std::vector<Group> groups;
  for (const std::string& object : options.objects) groups.push_back(addObject(opened_->scene, object));
  const scene::Scene& scene = opened_->scene;
  const asset::Asset* asset = opened_->asset ? &*opened_->asset : nullptr;
  const int shadows = options.shadow_size    ? options.shadow_size
                      : render::isSoftware() ? kSoftwareShadows
                                             : kDeviceShadows;
  renderer_ = std::make_unique<render::Renderer>(
      scene, render::ShadowOptions{.cube_size = shadows, .plane_size = 4 * shadows});
  const float aspect = static_cast<float>(options.size.x) / static_cast<float>(options.size.y);
  tracer_ = std::make_unique<trace::Tracer>(scene, trace::TracerOptions{.isa = "", .include_dynamic = true});
  camera = CameraControl(picture::defaultViewpoint(*tracer_, options.camera, aspect),
                         std::max(0.3f * scene.bounds().diagonal(), 0.1f));
  frame.lights = chooseLights(options.lights, scene);
  frame.background = Vec3(0.05f);
  frame.full_materials = true;
  if (frame.lights.empty()) frame.lights.push_back(lampFor(scene.bounds()));
  if (asset)
    for (const asset::Layer& l : asset->layers)
      if (l.kind == "lightpath" && (layer_.empty() || l.name == layer_)) {
        renderer_->setTransfer(*asset, l);
        readEntries(l);
        break;
      }
  has_obscurance =
      has(asset, [](const asset::Layer& l) { return l.kind == "obscurance" || l.kind == "spectral"; });
  if (has_obscurance) renderer_->setObscurance(asset->atlas, picture::obscurancePlane(*asset, ""));
  has_probes = has(asset, isProbeLayer);
  addObjects(*renderer_, scene, asset, groups,
             has_probes ? render::ObjectLight::kProbes : objectLightOf(options.object_light));
  frame.object_light = objectLightOf(options.object_light);
  for (const Group& group : groups) object_centre_.push_back(scene::boundsOf(scene, group).centre());
  object_moved.assign(groups.size(), Vec3(0));
  has_relief = std::any_of(scene.materials.begin(), scene.materials.end(),
                           [](const scene::Material& m) { return static_cast<bool>(m.height_texture); });
  views_ = viewsOf(asset);
  // A plain scene is seen under its lamps alone.
  if (!asset) views_.insert(views_.begin(), {"direct light", View::kRelit});
  caption_ = fmt::format("{}: {} triangles, {} lights", file.filename().string(), scene.triangleCount(),
                         frame.lights.size());
  if (!asset) caption_ += "; it carries no bake, so there is no indirect light (relume bake makes it)";
  showView();
}

void Stage::readEntries(const asset::Layer& layer) {
  const asset::Transfer transfer = asset::readTransfer(layer, opened_->asset->atlas);
  const codec::BlockMatrix& m = transfer.matrix;
  const asset::Entries& entries = transfer.entries;
  std::vector<std::uint32_t> cluster(m.columns, 0);
  for (std::uint32_t c = 0; c < m.clusters(); ++c)
    for (std::size_t k = m.cluster_first[c]; k < m.cluster_first[c + 1]; ++k)
      cluster[m.cluster_column[k]] = c;
  for (std::size_t p = 0; p < entries.patches(); ++p) {
    // The middle one of its points lies on the surface, where their mean may not.
    const std::size_t middle = p * entries.samples + entries.samples / 2;
    entries_.push_back(
        {entries.position[middle], entries.normal[middle], image::labelColour(cluster[entries.first[p]])});
  }
}

bool Stage::sees(Point p, Normal n) const {
  const Point start = p + 0.01f * n;
  const Vec3 way = camera.eye() - start;
  const float l = glm::length(way);
  return l > 0 && glm::dot(way, n) > 0 && !tracer_->occluded({start, way / l, l});
}

Truth& Stage::truth() {
  if (!truth_) truth_ = std::make_unique<Truth>(opened_->scene);
  return *truth_;
}

void Stage::choose(std::size_t view) {
  if (view >= views_.size()) return;
  view_ = view;
  showView();
}

void Stage::showView() {
  const View view = views_[view_].view;
  const asset::Asset* asset = opened_->asset ? &*opened_->asset : nullptr;
  frame.view = asset || view != View::kRelit ? viewFor(view) : render::View::kDirect;
  frame.ambient = Irradiance(view == View::kObscurance                       ? kPi
                             : view == View::kLit || view == View::kLightmap ? 0.3f
                                                                             : 0.0f);
  // Transfer was given to the renderer once; what else a view shows it gets now.
  if (asset && view != View::kRelit && view != View::kIndirect)
    showOnAtlas(*renderer_, opened_->scene, asset, view, "");
}

void Stage::draw(IVec2 size, bool present) {
  frame.size = size;
  frame.camera = cameraOf(camera.viewpoint());
  for (std::size_t i = 0; i < object_moved.size(); ++i) {
    Mat4 place(1);
    place[3] = Vec4(object_moved[i], 1);
    renderer_->placeObject(i, place);
  }
  renderer_->draw(frame);
  const bool data = frame.view == render::View::kOcclusion || frame.view >= render::View::kAlbedo;
  const bool lit = !data || frame.view == render::View::kDirect;
  if (auto_exposure && lit && frame.view != render::View::kObscurance) {
    const float wanted = chooseExposure(renderer_->thumbnail(), frame.background, true);
    exposure += kExposureStep * (wanted - exposure);
  }
  if (present) renderer_->present({.exposure_stops = lit ? exposure : 0.0f, .filmic = lit, .fxaa = fxaa});
  times_ = renderer_->times();
}

void Stage::addLight() {
  Light lamp = frame.lights.empty() ? lampFor(opened_->scene.bounds()) : frame.lights.back();
  if (lamp.kind == Light::Kind::kDirectional) lamp = lampFor(opened_->scene.bounds());
  lamp.name = fmt::format("lamp {}", frame.lights.size() + 1);
  lamp.position = camera.eye() + 0.5f * camera.reach() * camera.forward();
  frame.lights.push_back(lamp);
  selected = static_cast<int>(frame.lights.size()) - 1;
}

image::Image Stage::screenshot() const {
  const bool data = frame.view == render::View::kOcclusion ||
                    (frame.view >= render::View::kAlbedo && frame.view != render::View::kDirect);
  return image::toneMap(renderer_->read(), data ? image::ToneCurve::kPlain : image::ToneCurve::kFilmic,
                        data ? 0 : exposure);
}

}  // namespace relume::app
