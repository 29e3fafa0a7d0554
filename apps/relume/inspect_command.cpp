// SPDX-License-Identifier: MIT
// relume inspect: what a baked file carries.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command.h"
#include "day_inspection.h"
#include "files.h"
#include "relume/asset/asset.h"
#include "relume/core/error.h"
#include "relume/core/file.h"
#include "relume/core/memory.h"
#include "relume/scene/gltf.h"

namespace relume::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct InspectOptions {
  std::string asset, plots;
  bool json = false;
};

Json describe(const asset::Parameter& parameter) {
  // JSON has no infinity; the word is what --layer reads.
  if (const double* v = std::get_if<double>(&parameter); v && std::isinf(*v)) return "inf";
  return std::visit([](const auto& v) { return Json(v); }, parameter);
}

Json describe(const asset::Plane& plane) {
  const auto channels = static_cast<std::size_t>(plane.channels);
  double sum = 0;
  float lo = plane.values.empty() ? 0 : plane.values[0], hi = lo;
  for (const float v : plane.values) sum += v, lo = std::min(lo, v), hi = std::max(hi, v);
  return {{"name", plane.name},
          {"channels", plane.channels},
          {"texels", plane.values.size() / channels},
          {"mean", plane.values.empty() ? 0 : sum / static_cast<double>(plane.values.size())},
          {"min", lo},
          {"max", hi}};
}

/// What each layer takes in the file. `document` has been decoded, so its numbers lead somewhere.
void addSizes(Json& description, const nlohmann::json& document) {
  const auto& layers = document.at("extensions").at("RELUME_transfer").at("layers");
  for (std::size_t i = 0; i < layers.size(); ++i) {
    std::uint64_t bytes = 0;
    for (const char* arrays : {"planes", "tables"}) {
      if (!layers[i].contains(arrays)) continue;
      for (const auto& array : layers[i].at(arrays))
        bytes += document.at("bufferViews")
                     .at(array.at("bufferView").get<std::size_t>())
                     .at("byteLength")
                     .get<std::uint64_t>();
    }
    description["layers"][i]["bytes"] = bytes;
  }
}

Json describe(const asset::Asset& asset, std::size_t file_bytes) {
  Json out;
  out["generator"] = asset.generator;
  out["input_hash"] = asset.input_hash;
  out["file_bytes"] = file_bytes;
  const asset::AtlasTable& atlas = asset.atlas;
  const double texels = static_cast<double>(atlas.width) * atlas.height * atlas.pages;
  out["atlas"] = {
      {"width", atlas.width},
      {"height", atlas.height},
      {"pages", atlas.pages},
      {"covered_texels", atlas.texel.size()},
      {"coverage", texels > 0 ? static_cast<double>(atlas.texel.size()) / texels : 0},
      {"invalid_texels", std::count(atlas.valid.begin(), atlas.valid.end(), 0)},
      {"charts", atlas.chart.empty() ? 0 : *std::max_element(atlas.chart.begin(), atlas.chart.end()) + 1}};
  out["layers"] = Json::array();
  for (const asset::Layer& layer : asset.layers) {
    Json entry{{"name", layer.name},           {"kind", layer.kind},
               {"emitters", layer.emitters},   {"transport", layer.transport},
               {"receivers", layer.receivers}, {"codec", layer.codec},
               {"samples", layer.samples},     {"error_estimate", layer.error_estimate}};
    for (const auto& [key, value] : layer.parameters) entry["parameters"][key] = describe(value);
    for (const asset::Plane& plane : layer.planes) entry["planes"].push_back(describe(plane));
    if (layer.kind == "day") entry["day"] = describeDay(asset::dayFramesOf(layer, asset.atlas));
    out["layers"].push_back(std::move(entry));
  }
  return out;
}

std::string textOf(const Json& parameter) {
  if (parameter.is_number_float()) return fmt::format("{:.4g}", parameter.get<double>());
  return parameter.is_string() ? parameter.get<std::string>() : parameter.dump();
}

void printTable(const std::string& path, const Json& d, const asset::Asset& asset) {
  const Json& atlas = d["atlas"];
  fmt::print("{}: {}, baked by {}\n", path, formatSize(d["file_bytes"].get<std::size_t>()),
             d["generator"].get<std::string>());
  fmt::print(
      "atlas: {} x {}, {} page{}, {} covered texels ({:.1f} %), {} charts, {} buried texels filled\n\n",
      atlas["width"].get<int>(), atlas["height"].get<int>(), atlas["pages"].get<int>(),
      atlas["pages"].get<int>() == 1 ? "" : "s", atlas["covered_texels"].get<std::size_t>(),
      atlas["coverage"].get<double>() * 100, atlas["charts"].get<std::size_t>(),
      atlas["invalid_texels"].get<std::size_t>());
  for (const Json& layer : d["layers"]) {
    fmt::print("layer {}, {}\n", layer["name"].get<std::string>(),
               formatSize(layer["bytes"].get<std::uint64_t>()));
    fmt::print("  {} x {} x {} x {}\n", layer["emitters"].get<std::string>(),
               layer["transport"].get<std::string>(), layer["receivers"].get<std::string>(),
               layer["codec"].get<std::string>());
    for (const auto& [key, value] : layer["parameters"].items())
      fmt::print("  {:<12} {}\n", key, textOf(value));
    fmt::print("  {:<12} at most {} rays per texel, estimated relative error {:.2g} %\n", "samples",
               layer["samples"].get<std::uint64_t>(), layer["error_estimate"].get<double>() * 100);
    for (const Json& plane : layer.value("planes", Json::array()))
      fmt::print("  plane {:<10} {} channel{}, mean {:.4f}, from {:.4f} to {:.4f}\n",
                 plane["name"].get<std::string>(), plane["channels"].get<int>(),
                 plane["channels"].get<int>() == 1 ? "" : "s", plane["mean"].get<double>(),
                 plane["min"].get<double>(), plane["max"].get<double>());
    const asset::Layer& own = asset.layer(layer["name"].get<std::string>());
    if (own.kind == "day") printDay(asset::dayFramesOf(own, asset.atlas));
  }
}

void inspect(const InspectOptions& options, Progress&) {
  const auto bytes = readFile(options.asset);
  const asset::Asset asset = asset::decode(bytes, options.asset);
  Json description = describe(asset, bytes.size());
  const fs::path path = options.asset;
  addSizes(description,
           scene::gltf::Document::parse(bytes, path.filename().string(), path.parent_path()).json());
  if (options.json)
    fmt::print("{}\n", description.dump(2));
  else
    printTable(options.asset, description, asset);
  if (options.plots.empty()) return;
  makeFolder(options.plots);
  for (const asset::Layer& layer : asset.layers)
    if (layer.kind == "day") plotDay(asset::dayFramesOf(layer, asset.atlas), layer.name, options.plots);
}

}  // namespace

void addInspect(CLI::App& app, Program& program) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* command = app.add_subcommand("inspect",
                                         "What a baked file carries: atlas, layers, parameters, "
                                         "sizes.\nExample: relume inspect castle.baked.glb");
  command->add_option("ASSET", options->asset, "a baked .glb")->required();
  command->add_flag("--json", options->json, "print JSON");
  command->add_option("--plots", options->plots,
                      "folder for plots of layers `day`: intervals through the day, variance of components");
  onCommand(command, program, options, inspect);
}

}  // namespace relume::app
