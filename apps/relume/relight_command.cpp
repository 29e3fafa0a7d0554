// SPDX-License-Identifier: MIT
// relume relight: irradiance of every texel under other lights.
#include <fmt/format.h>

#include <optional>

#include "command.h"
#include "day.h"
#include "files.h"
#include "lights.h"
#include "relit.h"
#include "relume/core/file.h"
#include "relume/image/io.h"
#include "relume/picture/picture.h"
#include "relume/relight/obscurance.h"
#include "shadows.h"

namespace relume::app {
namespace {

struct RelightOptions {
  std::string time;
  std::string asset, lights, output, layer, ambient = "0";
  float beta = 0.1f;
  bool no_shadows = false;
  std::vector<std::string> gains;
};

std::vector<Irradiance> byObscurance(const RelightOptions& options, const asset::Asset& asset,
                                     const asset::Layer& layer, const LightSet& lights,
                                     const std::optional<trace::Tracer>& tracer) {
  if (layer.kind != "obscurance" && layer.kind != "spectral" && layer.kind != "ao")
    throw Error(ErrorCode::kNoSuchLayer, layer.name, "is not a layer that can be relit");
  relight::ObscuranceRelighter relighter(asset, layer);
  relight::VisibilitySource visibility;
  if (tracer) visibility = tracedVisibility(*tracer, asset.atlas.position, asset.atlas.normal, lights);
  const auto result = relighter.evaluate(
      lights, {.ambient = Irradiance(parseTriple(options.ambient, "--ambient", true)), .beta = options.beta},
      visibility);
  return {result.begin(), result.end()};
}

void relightAsset(const RelightOptions& options, Progress& progress) {
  requireWritable(options.output);
  const auto opened = open(options.asset);
  if (!opened->asset)
    throw Error(ErrorCode::kNoSuchLayer, options.asset, "carries no bake",
                "bake it first: relume bake " + options.asset);
  asset::Asset& asset = *opened->asset;
  const LightSet lights = chooseLights(options.lights, opened->scene);
  const asset::Layer& layer = asset.layer(options.layer);
  std::optional<trace::Tracer> tracer;
  if (!options.no_shadows) tracer.emplace(opened->scene);
  Stage stage(progress, "relight", 1);
  const std::vector<Irradiance> irradiance =
      picture::isTransfer(layer)
          ? relit(asset, layer,
                  {lights, tracer ? &*tracer : nullptr, options.gains,
                   options.time.empty() ? std::nullopt : std::optional(parseTime(options.time))})
          : byObscurance(options, asset, layer, lights, tracer);
  image::writeImage(options.output, toPages(asset.atlas, irradiance));
}

}  // namespace

void addRelight(CLI::App& app, Program& program) {
  auto options = std::make_shared<RelightOptions>();
  CLI::App* command = app.add_subcommand(
      "relight",
      "Irradiance of every texel under other lights: of a lightpath layer the indirect part, of\n"
      "obscurance all of it.\nExample: relume "
      "relight castle.baked.glb --lights evening.json -o evening.exr");
  command->add_option("ASSET", options->asset, "a baked .glb")->required();
  command->add_option("--time", options->time, "HH:MM, of a layer `day`; without it, 12:00");
  command->add_option("--lights", options->lights, "JSON list of lights; without it, the scene's own");
  command->add_option("-o,--output", options->output, "irradiance of the atlas, .exr or .hdr")->required();
  command->add_option("--layer", options->layer, "layer to relight; without it, the first");
  command->add_option("--ambient", options->ambient, "ambient irradiance, one number or R,G,B")
      ->capture_default_str();
  command
      ->add_option("--beta", options->beta, "share of every light that arrives everywhere as indirect light")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--gain", options->gains,
                      "of lightgroups, repeatable: GROUP=NUMBER or GROUP=R,G,B; without it, lamps as baked");
  command->add_flag("--no-shadows", options->no_shadows, "let lights shine through");
  onCommand(command, program, options, relightAsset);
}

}  // namespace relume::app
