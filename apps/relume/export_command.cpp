// SPDX-License-Identifier: MIT
// relume export: the planes of a layer as images.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "command.h"
#include "files.h"
#include "relume/asset/asset.h"
#include "relume/core/error.h"
#include "relume/image/io.h"

namespace relume::app {
namespace {

struct ExportOptions {
  std::string asset, layer, folder, format = "exr";
};

// All pages below one another. Always RGB, so that any program finds the channels it expects; directions in
// PNG are mapped from
// [-1, 1] to [0, 1] as in normal maps.
image::Image toImage(const asset::Asset& asset, const asset::Plane& plane, bool png) {
  image::Image out(asset.atlas.width, asset.atlas.height * static_cast<int>(asset.atlas.pages), 3);
  const auto channels = static_cast<std::size_t>(plane.channels);
  const bool signed_values =
      png && std::any_of(plane.values.begin(), plane.values.end(), [](float v) { return v < 0; });
  for (std::size_t i = 0; i < out.pixels(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = plane.values[i * channels + std::min(c, channels - 1)];
      out.data[i * 3 + c] = signed_values ? 0.5f * v + 0.5f : v;
    }
  }
  return out;
}

/// Planes may be named after lamps, which may be named anything.
std::string fileName(std::string name) {
  for (char& c : name)
    if (c == '/' || c == '\\' || c == ':' || static_cast<unsigned char>(c) < ' ') c = '_';
  return name;
}

void exportLayer(const ExportOptions& options, Progress&) {
  namespace fs = std::filesystem;
  const asset::Asset asset = asset::readAsset(options.asset);
  const asset::Layer& layer = asset.layer(options.layer);
  makeFolder(options.folder);
  for (const asset::Plane& plane : layer.planes) {
    const std::string stem = layer.planes.size() == 1 ? layer.name : layer.name + "-" + fileName(plane.name);
    const fs::path path = fs::path(options.folder) / (stem + "." + options.format);
    image::writeImage(path, toImage(asset, plane, options.format == "png"));
    fmt::print("{}\n", path.string());
  }
}

}  // namespace

void addExport(CLI::App& app, Program& program) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      app.add_subcommand("export",
                         "The planes of a layer as images; row 0 is v = 0, pages below one "
                         "another.\nExample: relume export castle.baked.glb --layer obscurance -o maps");
  command->add_option("ASSET", options->asset, "a baked .glb")->required();
  command->add_option("--layer", options->layer, "name of the layer, as relume inspect lists it")->required();
  command
      ->add_option("-o,--output", options->folder,
                   "folder; DIR/<layer>.exr, or DIR/<layer>-<plane>.exr when there are several")
      ->required();
  command->add_option("--format", options->format, "exr: 32-bit float; png: 8 bit sRGB; hdr")
      ->check(CLI::IsMember({"exr", "png", "hdr"}))
      ->capture_default_str();
  onCommand(command, program, options, exportLayer);
}

}  // namespace relume::app
