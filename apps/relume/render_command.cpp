// SPDX-License-Identifier: MIT
// relume render: a picture of a scene or of a bake.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "command.h"
#include "day.h"
#include "exposure.h"
#include "files.h"
#include "gl_picture.h"
#include "lights.h"
#include "reference_picture.h"
#include "relit.h"
#include "relume/asset/day_frames.h"
#include "relume/core/file.h"
#include "relume/image/colour.h"
#include "relume/image/io.h"
#include "relume/picture/baked_directions.h"
#include "relume/picture/picture.h"
#include "relume/scene/day_sky.h"

namespace relume::app {
namespace {

using picture::View;
constexpr std::array kViews = {View::kObscurance, View::kOcclusion, View::kLit,    View::kLightmap,
                               View::kRelit,      View::kIndirect,  View::kAlbedo, View::kNormal,
                               View::kBentNormal, View::kTexels,    View::kCharts, View::kValidity};

struct RenderOptions {
  std::string input, output, mode, view, layer, lights, ambient, background = "0.05", tone = "auto";
  std::string eye, target, size = "960x540", renderer = "cpu", materials, gloss = "ggx";
  std::string time, day;
  std::vector<std::string> gains;
  std::optional<float> exposure, error;
  std::optional<int> spp, bounces;
  std::uint64_t seed = 1;
  std::string obscurance_layer;
  std::vector<std::string> objects;
  std::string path;
  bool times = false;
  std::string object_light = "cube";
  std::vector<std::string> relief{"steps", "shadows", "occlusion"};
  float fov_deg = 50, beta = 0.1f, obscurance = 0, bounce = 0;
  int camera = -1;
};

std::vector<std::string> viewNames() {
  std::vector<std::string> names;
  for (const View view : kViews) names.emplace_back(picture::name(view));
  return names;
}

View viewOf(const std::string& text, const Opened& opened) {
  for (const View view : kViews)
    if (text == picture::name(view)) return view;
  if (!opened.asset) return View::kAlbedo;
  const auto is_lightmap = [](const asset::Layer& layer) {
    return layer.kind == "lightmap" || layer.kind == "directional";
  };
  const auto& layers = opened.asset->layers;
  if (std::any_of(layers.begin(), layers.end(), is_lightmap)) return View::kLightmap;
  if (std::any_of(layers.begin(), layers.end(), picture::isTransfer)) return View::kRelit;
  return opened.scene.lights.empty() ? View::kObscurance : View::kLit;
}

picture::Viewpoint viewpointOf(const RenderOptions& options, IVec2 size, const trace::Tracer& tracer) {
  if (options.eye.empty() != options.target.empty())
    throw Error(ErrorCode::kUsage, "--eye and --target", "belong together", "give both, or --camera");
  const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
  if (options.eye.empty()) return picture::defaultViewpoint(tracer, options.camera, aspect);
  const Point eye = parseTriple(options.eye, "--eye", false),
              target = parseTriple(options.target, "--target", false);
  if (eye == target) throw Error(ErrorCode::kUsage, "--eye and --target", "are the same point");
  return picture::lookAt(eye, target, glm::radians(options.fov_deg));
}

bool isRelit(View view) { return view == View::kRelit || view == View::kIndirect; }

/// Shows light that may be as bright as lamps make it.
bool isLit(View view) { return view == View::kLit || view == View::kLightmap || isRelit(view); }

bool isData(View view) {
  return view == View::kNormal || view == View::kBentNormal || view == View::kCharts ||
         view == View::kTexels || view == View::kValidity || view == View::kOcclusion ||
         view == View::kAlbedo;
}

// Lamps need a curve that bends bright light; the obscurance of ambient light is between 0 and 1 as it is.
image::ToneCurve curveOf(const RenderOptions& options, View view) {
  const bool filmic = options.tone == "filmic" || (options.tone == "auto" && isLit(view));
  return filmic && !isData(view) ? image::ToneCurve::kFilmic : image::ToneCurve::kPlain;
}

/// Linear to .exr and .hdr, as a display shows it to .png. Pictures with lamps get an exposure when nobody
/// gives one.
void writePicture(const RenderOptions& options, const image::Image& linear, View view, Vec3 background) {
  if (!options.output.ends_with(".png")) return image::writeImage(options.output, linear);
  float stops = isData(view) ? 0.0f : options.exposure.value_or(0.0f);
  if (isLit(view) && !options.exposure) {
    stops = chooseExposure(linear, background, !options.mode.empty());
    if (stops != 0.0f) fmt::print("shown with --exposure {:.1f}\n", stops);
  }
  image::writeImage(options.output, image::toneMap(linear, curveOf(options, view), stops));
}

void renderReference(const RenderOptions& options, Progress& progress) {
  const auto opened = open(options.input, {.normal_maps = true});
  const IVec2 size = parseExtent(options.size, "--size");
  for (const std::string& object : options.objects) addObject(opened->scene, object);
  if (options.time.empty())
    lightScene(opened->scene, options.lights, options.ambient);
  else
    scene::lightAt(opened->scene,
                   dayOf(opened->asset ? &*opened->asset : nullptr, options.layer, options.day),
                   parseTime(options.time));
  transport::ReferenceOptions how;
  how.target_error = options.error.value_or(0.0f);
  how.samples = static_cast<std::uint32_t>(options.spp.value_or(options.error ? 1 << 16 : 64));
  how.max_bounces = options.mode == "direct" ? 0 : options.bounces.value_or(how.kUnlimited);
  how.seed = options.seed;
  if (options.materials == "lambert") how.materials = transport::Materials::kLambert;
  how.background = parseTriple(options.background, "--background", true);
  const transport::Reference reference(opened->scene, {.isa = "", .include_dynamic = true});
  const picture::Viewpoint viewpoint = viewpointOf(options, size, reference.tracer());
  const image::Image linear = referencePicture(reference, viewpoint, size, how, progress);
  writePicture(options, linear, View::kLit, how.background);
}

std::optional<double> minutesOf(const RenderOptions& options) {
  return options.time.empty() ? std::nullopt : std::optional(parseTime(options.time));
}

/// Of what a bake knows of a day; of what it does not (no time was given): null.
asset::Layer* shownDay(const RenderOptions& options, Opened& opened) {
  if (options.time.empty()) return nullptr;
  if (options.mode != "relit")
    throw Error(ErrorCode::kUsage, "--time", "is of a day's light", "add --mode relit or --mode reference");
  asset::Layer* layer = opened.asset ? dayLayer(*opened.asset, options.layer) : nullptr;
  if (!layer) throw Error(ErrorCode::kNoSuchLayer, options.input, "holds no day", "bake --layer day first");
  return layer;
}

/// What stands still is lit as the run time lights it; only that throws shadows on what light enters by.
void relightForPicture(const RenderOptions& options, picture::PictureOptions& picture, Opened& opened) {
  if (!opened.asset)
    throw Error(ErrorCode::kNoSuchLayer, options.input, "carries no bake", "bake it first: relume bake");
  const trace::Tracer shadows(opened.scene);
  addRelitPlane(*opened.asset, picture.layer, {picture.lights, &shadows, options.gains, minutesOf(options)});
  // What holds all light already needs no lamps beside it.
  const auto& parameters = transferLayer(*opened.asset, picture.layer).parameters;
  const auto part = parameters.find("part");
  if (part != parameters.end() && part->second != asset::Parameter(std::string("indirect")))
    picture.lights.clear();
}

/// Whether relit light is that of a layer that knows all light by direction already.
bool showsOwnLight(const Opened& opened, const std::string& layer) {
  if (!opened.asset) return false;
  if (!layer.empty()) return picture::isDirectional(opened.asset->layer(layer));
  const auto& layers = opened.asset->layers;
  return std::none_of(layers.begin(), layers.end(), picture::isTransfer) &&
         std::any_of(layers.begin(), layers.end(), picture::isDirectional);
}

/// What OpenGL shows and rays do not.
GlExtras extrasOf(const RenderOptions& options, const std::vector<Group>& objects) {
  const auto relief = [&](const char* part) {
    return std::find(options.relief.begin(), options.relief.end(), part) != options.relief.end();
  };
  return {.full_materials = options.materials == "full",
          .relief_steps = relief("steps"),
          .relief_shadows = relief("shadows"),
          .small_scale = relief("occlusion") ? 1.0f : 0.0f,
          .objects = objects,
          .object_light = objectLightOf(options.object_light)};
}

/// "walk.png" to "walk-00001.png" and so on. One exposure for all, or frames would flicker.
void renderPath(const RenderOptions& options, const Opened& opened, const picture::PictureOptions& picture,
                const GlExtras& extras) {
  const std::vector<PathFrame> path = parsePath(readTextFile(options.path), options.path);
  if (options.times) {
    fmt::print("{}",
               timesOfPath(opened.scene, opened.asset ? &*opened.asset : nullptr, path, picture, extras));
    return;
  }
  const std::filesystem::path output = options.output;
  RenderOptions each = options;
  glPictures(opened.scene, opened.asset ? &*opened.asset : nullptr, path, picture, extras,
             [&](std::size_t i, const image::Image& linear) {
               if (i == 0 && !options.exposure && isLit(picture.view))
                 each.exposure = chooseExposure(linear, picture.background, !options.mode.empty());
               each.output = (output.parent_path() / fmt::format("{}-{:05}{}", output.stem().string(), i + 1,
                                                                 output.extension().string()))
                                 .string();
               writePicture(each, linear, picture.view, picture.background);
             });
  fmt::print("{} pictures\n", path.size());
}

void renderPicture(const RenderOptions& options, Progress& progress) {
  requireWritable(options.output);
  if (options.mode == "reference" || options.mode == "direct") {
    if (options.renderer == "gl")
      throw Error(ErrorCode::kUsage, "--renderer gl",
                  fmt::format("traces no paths, which --mode {} needs", options.mode),
                  "leave it out, or choose --mode relit");
    return renderReference(options, progress);
  }
  if (options.materials == "full" && options.renderer != "gl")
    throw Error(ErrorCode::kUsage, "--materials full", "is not what rays show of a relit bake",
                "add --renderer gl, or choose --mode reference");
  const auto opened = open(options.input, {.normal_maps = true});
  std::vector<Group> objects;
  for (const std::string& object : options.objects) objects.push_back(addObject(opened->scene, object));
  asset::Layer* day = shownDay(options, *opened);
  if (day) scene::lightAt(opened->scene, dayOf(&*opened->asset, day->name, options.day), *minutesOf(options));
  const trace::Tracer tracer(opened->scene, {.isa = "", .include_dynamic = true});
  const IVec2 size = parseExtent(options.size, "--size");
  picture::PictureOptions picture{.width = size.x, .height = size.y, .samples = options.spp.value_or(16)};
  picture.view = options.mode == "relit" ? View::kRelit : viewOf(options.view, *opened);
  if (options.mode == "relit" && showsOwnLight(*opened, options.layer)) picture.view = View::kLightmap;
  const bool gl = options.renderer == "gl";
  picture.layer = day ? day->name : options.layer;
  if (day) picture.environment = opened->scene.environment;
  picture.gloss = options.gloss == "none"    ? picture::Gloss::kNone
                  : options.gloss == "phong" ? picture::Gloss::kPhong
                                             : picture::Gloss::kGgx;
  picture.lights = chooseLights(options.lights, opened->scene);
  // Without a word, an ambient light that shows the obscurance: alone it makes white surfaces white, beside
  // lamps it is faint.
  const bool beside_lamps =
      picture.view == View::kLightmap || (picture.view == View::kLit && !picture.lights.empty());
  const std::string ambient = !options.ambient.empty() ? options.ambient
                              : isRelit(picture.view)  ? "0"
                              : beside_lamps           ? "0.3"
                                                       : "3.14159265";
  picture.ambient = Irradiance(parseTriple(ambient, "--ambient", true));
  picture.beta = options.beta;
  picture.obscurance = options.obscurance, picture.bounce = options.bounce;
  picture.obscurance_layer = options.obscurance_layer;
  if ((options.obscurance > 0 || options.bounce > 0) && !isRelit(picture.view))
    throw Error(ErrorCode::kUsage, "--obscurance and --bounce", "weight the light that a bake is relit with",
                "add --mode relit or --view indirect");
  picture.background = parseTriple(options.background, "--background", true);
  const picture::Viewpoint viewpoint = viewpointOf(options, size, tracer);
  const bool pixels =
      day && asset::dayFramesOf(*day, opened->asset->atlas).receivers != asset::DayFrames::Receivers::kAtlas;
  if (pixels)
    day->planes = {{.name = "value",
                    .channels = 3,
                    .values = std::vector<float>(opened->asset->atlas.pageTexels() * 3, 0.0f)}};
  else if (isRelit(picture.view) && !(gl && followsLamps(*opened, picture.layer)))
    relightForPicture(options, picture, *opened);
  const asset::Asset* asset = opened->asset ? &*opened->asset : nullptr;
  if (!options.path.empty()) {
    if (!gl) throw Error(ErrorCode::kUsage, "--path", "is drawn by OpenGL", "add --renderer gl");
    return renderPath(options, *opened, picture, extrasOf(options, objects));
  }
  image::Image linear = gl ? glPicture(opened->scene, asset, viewpoint, picture, extrasOf(options, objects))
                           : picture::render(tracer, asset, viewpoint, picture, progress);
  if (pixels) addPixelLight(tracer, *asset, *day, *minutesOf(options), viewpoint, picture, linear, progress);
  writePicture(options, linear, picture.view, picture.background);
}

}  // namespace

void addRender(CLI::App& app, Program& program) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand(
      "render",
      "A picture of a scene or a bake, to .png or linear .exr.\nExample: relume render "
      "castle.baked.glb -o castle.png --camera 0 --view obscurance\nExample: relume render "
      "castle.glb -o truth.exr --mode reference --error 0.02");
  command->add_option("INPUT", options->input, "a scene (.gltf, .glb) or a baked .glb")->required();
  command->add_option("-o,--output", options->output, "picture: .png (tone-mapped), .exr or .hdr (linear)")
      ->required();
  CLI::Option* mode =
      command
          ->add_option("--mode", options->mode,
                       "reference: all light, path-traced without bias; direct: the same with light straight "
                       "from lamps alone; relit: lamps and the light that the bake makes of them. Without "
                       "it, a view of the bake")
          ->check(CLI::IsMember({"reference", "direct", "relit"}));
  command
      ->add_option("--view", options->view,
                   "what to show; without it, lightmap where the bake has one, lit where the scene has "
                   "lights, obscurance "
                   "where it has none, "
                   "albedo without a bake")
      ->check(CLI::IsMember(viewNames()))
      ->excludes(mode);
  command->add_option("--layer", options->layer, "layer to show; without it, the first that fits");
  command
      ->add_option("--camera", options->camera,
                   "camera of the file; -1: its first, or one that frames the scene")
      ->capture_default_str();
  command->add_option("--eye", options->eye, "x,y,z of the eye, metres; with --target");
  command->add_option("--target", options->target, "x,y,z to look at, metres");
  command->add_option("--fov", options->fov_deg, "vertical field of view for --eye, degrees")
      ->check(CLI::Range(1.0, 170.0))
      ->capture_default_str();
  command->add_option("--size", options->size, "width x height")->capture_default_str();
  command
      ->add_option("--spp", options->spp,
                   "samples per pixel, or the most of them beside --error; without it, 16, with --mode 64")
      ->check(CLI::Range(1, 65536));
  command
      ->add_option("--error", options->error,
                   "with --mode: sample each part of the picture until its estimated standard error is below "
                   "this share of its brightness, e.g. 0.02")
      ->check(CLI::Range(1e-4, 1.0))
      ->needs(mode);
  command
      ->add_option("--bounces", options->bounces,
                   "with --mode reference: how often light may be reflected before it reaches what is seen; "
                   "without it, endlessly")
      ->check(CLI::Range(0, 1000000))
      ->needs(mode);
  command
      ->add_option(
          "--materials", options->materials,
          "full: metallic and rough as glTF has it, with normal maps; lambert: diffuse alone, as lightmaps "
          "have it. Without it, full with --mode reference and direct, else lambert; full needs one of "
          "these or --renderer gl")
      ->check(CLI::IsMember({"full", "lambert"}));
  command->add_option("--seed", options->seed, "with --mode: of the random numbers")
      ->needs(mode)
      ->capture_default_str();
  command
      ->add_option("--gloss", options->gloss,
                   "of a lightmap with a directional receiver: ggx as materials say, phong, or none: diffuse")
      ->check(CLI::IsMember({"ggx", "phong", "none"}))
      ->capture_default_str();
  command->add_option("--gain", options->gains,
                      "of lightgroups, repeatable: GROUP=NUMBER or GROUP=R,G,B; without it, lamps as baked");
  command->add_option("--lights", options->lights, "JSON list of lights; without it, the scene's own");
  command
      ->add_option("--time", options->time,
                   "HH:MM: sun, sky and lamps at that time of a baked day; needs --mode relit or reference")
      ->needs(mode);
  command->add_option("--day", options->day, "DAY.json instead of the day that was baked");
  command->add_option("--ambient", options->ambient,
                      "ambient irradiance, one number or R,G,B; without it, pi, or 0.3 beside lights. With "
                      "--mode, from an environment of that constant light; without it, none beside lights");
  command
      ->add_option("--beta", options->beta, "share of every light that arrives everywhere as indirect light")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--obscurance", options->obscurance,
                   "with --mode relit: share by which an obscurance or spectral layer of the bake darkens "
                   "indirect light, 1 as published")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--bounce", options->bounce,
                   "with --mode relit: this times obscurance times direct light is added, for light whose "
                   "last way is short; 1 as published, which is bright")
      ->check(CLI::Range(0.0, 4.0))
      ->capture_default_str();
  command->add_option("--obscurance-layer", options->obscurance_layer,
                      "the layer for both; without it, the first spectral, else obscurance");
  command->add_option(
      "--object", options->objects,
      "repeatable: FILE.glb@x,y,z[,turn[,scale]] puts its origin there, turned by degrees; it was "
      "not there when the scene was baked");
  CLI::Option* path = command->add_option(
      "--path", options->path,
      "with --renderer gl: a path of camera and lamps that relume view recorded; a picture for "
      "each of its frames, OUT-00001.png and so on");
  command
      ->add_flag("--times", options->times,
                 "draw the path as a window would, write nothing, and print what each pass takes (median)")
      ->needs(path);
  command
      ->add_option("--object-light", options->object_light,
                   "with --renderer gl: indirect light on objects: of a cube map about each, of the bake's "
                   "probes (lightpath:exits=probes), or none")
      ->check(CLI::IsMember({"cube", "probes", "none"}))
      ->capture_default_str();
  command
      ->add_option("--relief", options->relief,
                   "with --materials full: what height maps do, of steps, shadows and occlusion; or none")
      ->delimiter(',')
      ->check(CLI::IsMember({"steps", "shadows", "occlusion", "none"}))
      ->capture_default_str();
  command->add_option(
      "--exposure", options->exposure,
      "stops, for .png; without it, 0, or less where lamps would leave nothing but white, and with "
      "--mode more where they would leave nothing but black");
  command->add_option("--tone", options->tone, "tone curve, for .png; auto: filmic for lit pictures")
      ->check(CLI::IsMember({"auto", "filmic", "plain"}))
      ->capture_default_str();
  command->add_option("--background", options->background, "linear, one number or R,G,B")
      ->capture_default_str();
  command
      ->add_option("--renderer", options->renderer,
                   "cpu: rays; gl: OpenGL 4.5 without a window, of views and --mode relit")
      ->check(CLI::IsMember({"cpu", "gl"}))
      ->capture_default_str();
  onCommand(command, program, options, renderPicture);
}

}  // namespace relume::app
