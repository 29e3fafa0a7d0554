// SPDX-License-Identifier: MIT
// relume relief: normal map, cone map and occlusion out of a height map.
#include <fmt/format.h>

#include <algorithm>

#include "command.h"
#include "files.h"
#include "relume/core/error.h"
#include "relume/core/file.h"
#include "relume/image/io.h"
#include "relume/image/relief.h"

namespace relume::app {
namespace {

struct ReliefCommand {
  std::string input, output;
  float depth = 0.05f;
};

/// Heights in [0, 1]. Images of 8 and 16 bits hold them as they are; the reader takes them for colours.
image::Image readHeights(const std::string& path) {
  const image::Image file = image::readImage(path);
  const bool colours = !path.ends_with(".exr") && !path.ends_with(".hdr");
  image::Image heights(file.width, file.height, 1);
  for (std::size_t i = 0; i < heights.data.size(); ++i) {
    const float v = file.data[i * static_cast<std::size_t>(file.channels)];
    heights.data[i] = colours ? image::linearToSrgb(v) : v;
    if (!(heights.data[i] >= 0 && heights.data[i] <= 1))
      throw Error(ErrorCode::kInvalidValue, path, fmt::format("has a height of {}", heights.data[i]),
                  "heights go from 0 (bottom) to 1 (top)");
  }
  return heights;
}

void write(const std::filesystem::path& path, const image::Image& values) {
  writeFileAtomically(path, image::encodePngData(values));
  fmt::print("{}\n", path.string());
}

void makeRelief(const ReliefCommand& options, Progress&) {
  const image::Image heights = readHeights(options.input);
  const image::ReliefOptions how{.depth = options.depth};
  const image::Image normals = image::reliefNormals(heights, how), cones = image::reliefCones(heights, how);
  image::Image shown = normals;
  for (float& v : shown.data) v = 0.5f * (v + 1);
  const std::string stem = options.output.empty() ? beside(options.input, "").string() : options.output;
  write(stem + "-normal.png", shown);
  write(stem + "-cone.png", cones);
  write(stem + "-occlusion.png", image::reliefOcclusion(heights, normals, cones));
}

}  // namespace

void addRelief(CLI::App& app, Program& program) {
  auto options = std::make_shared<ReliefCommand>();
  CLI::App* command = app.add_subcommand(
      "relief",
      "Out of a height map that repeats: a normal map, a cone map (sine of half the aperture of the widest "
      "free cone) and "
      "the light that the relief leaves its own points.\nExample: relume relief stones.png --depth 0.04");
  command->add_option("HEIGHT", options->input, "grey image, white on top")->required();
  command->add_option("-o,--output", options->output,
                      "what names begin with; without it, that of the height map");
  command->add_option("--depth", options->depth, "from white to black, as a share of the map's width")
      ->check(CLI::Range(1e-4, 10.0))
      ->capture_default_str();
  onCommand(command, program, options, makeRelief);
}

}  // namespace relume::app
