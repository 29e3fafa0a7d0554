// SPDX-License-Identifier: MIT
#include "gl_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "relit.h"
#include "relume/core/error.h"
#include "relume/image/colour.h"
#include "relume/picture/baked_directions.h"
#include "relume/picture/baked_values.h"
#include "relume/render/context.h"

namespace relume::app {
namespace {

constexpr Vec3 kInvalid{1.0f, 0.0f, 0.0f};
constexpr Vec3 kValid{0.5f};
constexpr Vec3 kNoChart{0.2f};
constexpr Vec3 kWithoutBake{1.0f, 0.0f, 1.0f};
constexpr render::ShadowOptions kFineShadows{.cube_size = 1024, .plane_size = 4096};

bool showsTransfer(picture::View view) {
  return view == picture::View::kRelit || view == picture::View::kIndirect;
}

std::vector<Vec3> labelsOf(const asset::AtlasTable& atlas, picture::View view) {
  std::vector<Vec3> colours;
  for (std::size_t i = 0; i < atlas.texel.size(); ++i)
    colours.push_back(view == picture::View::kCharts ? image::labelColour(atlas.chart[i])
                      : atlas.valid[i]               ? kValid
                                                     : kInvalid);
  return colours;
}

}  // namespace

bool followsLamps(const Opened& opened, const std::string& layer) {
  if (!opened.asset) return false;
  asset::Asset copy_of_names;  // transferLayer chooses among layers, and says what is missing
  for (const asset::Layer& l : opened.asset->layers)
    copy_of_names.layers.push_back({.name = l.name, .kind = l.kind});
  return transferLayer(copy_of_names, layer).kind == "lightpath";
}

render::View viewFor(picture::View view) {
  switch (view) {
    case picture::View::kObscurance:
      return render::View::kObscurance;
    case picture::View::kOcclusion:
      return render::View::kOcclusion;
    case picture::View::kLit:
      return render::View::kLit;
    case picture::View::kLightmap:
      return render::View::kLightmap;
    case picture::View::kRelit:
      return render::View::kRelit;
    case picture::View::kIndirect:
      return render::View::kIndirect;
    case picture::View::kAlbedo:
      return render::View::kAlbedo;
    case picture::View::kNormal:
      return render::View::kNormal;
    case picture::View::kBentNormal:
      return render::View::kBentNormal;
    case picture::View::kTexels:
      return render::View::kTexels;
    case picture::View::kCharts:
    case picture::View::kValidity:
      return render::View::kLabels;
  }
  return render::View::kAlbedo;
}

render::Camera cameraOf(const picture::Viewpoint& viewpoint) {
  return {viewpoint.world_from_camera, viewpoint.vertical_fov, viewpoint.ortho_height};
}

void showOnAtlas(render::Renderer& renderer, const scene::Scene& scene, const asset::Asset* asset,
                 picture::View view, const std::string& layer) {
  if (asset && showsTransfer(view)) {
    const picture::BakedValues match(scene, asset, picture::View::kCharts, "");  // throws where they do not
    const auto wanted = [&](const asset::Layer& l) {
      return layer.empty() ? picture::isTransfer(l) : l.name == layer;
    };
    const auto found = std::find_if(asset->layers.begin(), asset->layers.end(), wanted);
    if (found != asset->layers.end() && found->kind == "lightpath")
      return renderer.setTransfer(*asset, *found);
  }
  const picture::BakedValues baked(scene, asset, view, layer);
  if (view == picture::View::kLightmap && baked.layer() && baked.layer()->kind == "directional") {
    renderer.setValues(asset->atlas, *baked.valuePlane());
    return renderer.setDirections(*asset, *baked.layer());
  }
  if (view == picture::View::kLightmap && baked.layer() && picture::isDirectional(*baked.layer()))
    throw Error(ErrorCode::kUnsupported, "layer " + baked.layer()->name,
                "keeps light by direction, which OpenGL does not show here", "take --renderer cpu");
  if (baked.valuePlane()) renderer.setValues(asset->atlas, *baked.valuePlane());
  if (baked.bentPlane()) renderer.setBent(asset->atlas, *baked.bentPlane());
  if (view == picture::View::kCharts || view == picture::View::kValidity)
    renderer.setLabels(asset->atlas, labelsOf(asset->atlas, view),
                       view == picture::View::kCharts ? kNoChart : kWithoutBake);
}

render::ObjectLight objectLightOf(const std::string& name) {
  return name == "probes" ? render::ObjectLight::kProbes
         : name == "none" ? render::ObjectLight::kNone
                          : render::ObjectLight::kCube;
}

bool isProbeLayer(const asset::Layer& layer) {
  const auto found = layer.parameters.find("exits");
  return layer.kind == "lightpath" && found != layer.parameters.end() &&
         found->second == asset::Parameter(std::string("probes"));
}

void addObjects(render::Renderer& renderer, const scene::Scene& scene, const asset::Asset* asset,
                const std::vector<Group>& groups, render::ObjectLight light) {
  for (const Group& group : groups) renderer.addObject(objectOf(scene, group));
  if (groups.empty() || light != render::ObjectLight::kProbes) return;
  if (asset)
    for (const asset::Layer& layer : asset->layers)
      if (isProbeLayer(layer)) return renderer.setProbes(*asset, layer);
  throw Error(ErrorCode::kNoSuchLayer, "the bake", "has no probes to light objects by",
              "bake lightpath:exits=probes, or take --object-light cube");
}

namespace {

/// A renderer with all that the options say but where from and under which lights.
class Prepared {
 public:
  Prepared(const scene::Scene& scene, const asset::Asset* asset, const picture::PictureOptions& options,
           const GlExtras& extras)
      : renderer(scene, kFineShadows) {
    showOnAtlas(renderer, scene, asset, options.view, options.layer);
    addObjects(renderer, scene, asset, extras.objects, extras.object_light);
    frame.object_light = extras.object_light;
    frame.size = {options.width, options.height};
    frame.view = viewFor(options.view);
    frame.ambient = options.ambient;
    frame.beta = options.beta;
    frame.background = options.background;
    frame.gloss = options.gloss == picture::Gloss::kNone    ? render::Gloss::kNone
                  : options.gloss == picture::Gloss::kPhong ? render::Gloss::kPhong
                                                            : render::Gloss::kGgx;
    frame.full_materials = extras.full_materials;
    frame.relief_steps = extras.relief_steps, frame.relief_shadows = extras.relief_shadows;
    frame.small_scale_gain = extras.small_scale;
    if (asset && picture::weightsByObscurance(options)) {
      renderer.setObscurance(asset->atlas, picture::obscurancePlane(*asset, options.obscurance_layer));
      frame.obscurance_gain = options.obscurance, frame.bounce_gain = options.bounce;
    }
    shows_lights_ = options.view == picture::View::kLit || showsTransfer(options.view);
    samples_ = options.samples;
  }
  image::Image picture(const picture::Viewpoint& viewpoint, const LightSet& lights) {
    frame.camera = cameraOf(viewpoint);
    if (shows_lights_) frame.lights = lights;
    return renderer.picture(frame, samples_);
  }

  render::Renderer renderer;
  render::FrameSettings frame;

 private:
  bool shows_lights_ = false;
  int samples_ = 1;
};

}  // namespace

image::Image glPicture(const scene::Scene& scene, const asset::Asset* asset,
                       const picture::Viewpoint& viewpoint, const picture::PictureOptions& options,
                       const GlExtras& extras) {
  const render::HeadlessContext context;
  return Prepared(scene, asset, options, extras).picture(viewpoint, options.lights);
}

void glPictures(const scene::Scene& scene, const asset::Asset* asset, const std::vector<PathFrame>& path,
                const picture::PictureOptions& options, const GlExtras& extras,
                const std::function<void(std::size_t, const image::Image&)>& take) {
  const render::HeadlessContext context;
  Prepared prepared(scene, asset, options, extras);
  for (std::size_t i = 0; i < path.size(); ++i) {
    for (std::size_t k = 0; k < std::min(path[i].moved.size(), extras.objects.size()); ++k) {
      Mat4 place(1);
      place[3] = Vec4(path[i].moved[k], 1);
      prepared.renderer.placeObject(k, place);
    }
    take(i, prepared.picture(path[i].viewpoint, path[i].lights));
  }
}

std::string timesOfPath(const scene::Scene& scene, const asset::Asset* asset,
                        const std::vector<PathFrame>& path, const picture::PictureOptions& options,
                        const GlExtras& extras) {
  const render::HeadlessContext context;
  Prepared prepared(scene, asset, options, extras);
  std::map<std::string, std::vector<double>> seconds;
  for (const PathFrame& at : path) {
    prepared.frame.camera = cameraOf(at.viewpoint);
    prepared.frame.lights = at.lights;
    prepared.renderer.draw(prepared.frame);
    std::map<std::string, double> of_frame;
    for (const render::PassTime& pass : prepared.renderer.times()) of_frame[pass.name] += pass.seconds;
    for (const auto& [pass, time] : of_frame) seconds[pass].push_back(time), of_frame[pass] = time;
  }
  std::string text = fmt::format("{}\n", render::deviceName());
  double sum = 0;
  for (auto& [pass, all] : seconds) {
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    text += fmt::format("{}: {:.3f} ms\n", pass, 1e3 * *middle);
    sum += *middle;
  }
  text += fmt::format("all: {:.3f} ms\ntransfer: {} bytes\n", 1e3 * sum, prepared.renderer.sampleBytes());
  return text;
}

}  // namespace relume::app
