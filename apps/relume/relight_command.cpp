// SPDX-License-Identifier: MIT
// relume relight: irradiance of every texel under other lights.
#include <fmt/format.h>

#include "command.h"
#include "files.h"
#include "lights.h"
#include "relume/atlas/texels.h"
#include "relume/core/file.h"
#include "relume/image/io.h"
#include "relume/relight/obscurance.h"
#include "shadows.h"

namespace relume::app {
namespace {

struct RelightOptions {
  std::string asset, lights, output, layer, ambient = "0";
  float beta = 0.1f;
  bool no_shadows = false;
};

image::Image toPages(const asset::AtlasTable& atlas, std::span<const Irradiance> irradiance) {
  image::Image pages(atlas.width, atlas.height * static_cast<int>(atlas.pages), 3);
  std::vector<std::uint8_t> covered(pages.pixels(), 0);
  for (std::size_t i = 0; i < atlas.texel.size(); ++i) {
    const std::size_t texel = atlas.texel[i];
    for (int c = 0; c < 3; ++c) pages.data[texel * 3 + static_cast<std::size_t>(c)] = irradiance[i].rgb[c];
    covered[texel] = 1;
  }
  atlas::dilate(atlas.width, atlas.height, atlas.pages, 3, pages.data, std::move(covered));
  return pages;
}

void relightAsset(const RelightOptions& options, Progress& progress) {
  requireWritable(options.output);
  const auto opened = open(options.asset);
  if (!opened->asset)
    throw Error(ErrorCode::kNoSuchLayer, options.asset, "carries no bake",
                "bake it first: relume bake " + options.asset);
  const asset::Asset& asset = *opened->asset;
  const asset::Layer& layer = asset.layer(options.layer);
  if (layer.kind != "obscurance" && layer.kind != "spectral" && layer.kind != "ao")
    throw Error(ErrorCode::kNoSuchLayer, layer.name, "is not a layer that can be relit");
  const LightSet lights = chooseLights(options.lights, opened->scene);
  const relight::ObscuranceOptions relighting{
      .ambient = Irradiance(parseTriple(options.ambient, "--ambient", true)), .beta = options.beta};
  Stage stage(progress, "relight", 1);
  relight::ObscuranceRelighter relighter(asset, layer);
  if (options.no_shadows) {
    image::writeImage(options.output, toPages(asset.atlas, relighter.evaluate(lights, relighting)));
    return;
  }
  const trace::Tracer tracer(opened->scene);
  const auto visibility = tracedVisibility(tracer, asset.atlas, lights);
  image::writeImage(options.output, toPages(asset.atlas, relighter.evaluate(lights, relighting, visibility)));
}

}  // namespace

void addRelight(CLI::App& app, Program& program) {
  auto options = std::make_shared<RelightOptions>();
  CLI::App* command = app.add_subcommand("relight",
                                         "Irradiance of every texel under other lights.\nExample: relume "
                                         "relight castle.baked.glb --lights evening.json -o evening.exr");
  command->add_option("ASSET", options->asset, "a baked .glb")->required();
  command->add_option("--lights", options->lights, "JSON list of lights; without it, the scene's own");
  command->add_option("-o,--output", options->output, "irradiance of the atlas, .exr or .hdr")->required();
  command->add_option("--layer", options->layer, "layer to relight; without it, the first");
  command->add_option("--ambient", options->ambient, "ambient irradiance, one number or R,G,B")
      ->capture_default_str();
  command
      ->add_option("--beta", options->beta, "share of every light that arrives everywhere as indirect light")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_flag("--no-shadows", options->no_shadows, "let lights shine through");
  onCommand(command, program, options, relightAsset);
}

}  // namespace relume::app
