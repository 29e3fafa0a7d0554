// SPDX-License-Identifier: MIT
#include "day.h"

#include <fmt/format.h>

#include <algorithm>

#include "relume/core/error.h"
#include "relume/core/file.h"
#include "relume/core/parallel.h"
#include "relume/picture/primary_rays.h"
#include "relume/relight/day_file.h"
#include "relume/relight/day_relighter.h"

namespace relume::app {

bake::DayPlan readDay(const std::string& file) {
  if (file.empty()) return {};
  bake::DayPlan plan;
  plan.text = readTextFile(file);
  plan.day = relight::parseDay(plan.text, file);
  return plan;
}

asset::Layer* dayLayer(asset::Asset& asset, const std::string& name) {
  if (!name.empty() && asset.layer(name).kind != "day")
    throw Error(ErrorCode::kMismatch, "layer " + name, "holds no day", "name a layer of kind day");
  const auto found = std::find_if(asset.layers.begin(), asset.layers.end(), [&](const asset::Layer& layer) {
    return name.empty() ? layer.kind == "day" : layer.name == name;
  });
  return found == asset.layers.end() ? nullptr : &*found;
}

Day dayOf(asset::Asset* asset, const std::string& layer, const std::string& file) {
  if (!file.empty()) return readDay(file).day;
  if (asset)
    if (const asset::Layer* found = dayLayer(*asset, layer))
      return relight::DayRelighter(*asset, *found).day();
  throw Error(ErrorCode::kUsage, "--time", "of which day?",
              "give --day DAY.json, or a bake with a layer `day`");
}

double parseTime(const std::string& text) {
  const auto minutes = clockMinutes(text);
  if (!minutes) throw Error(ErrorCode::kUsage, "--time " + text, "is no time of the day", "write HH:MM");
  return *minutes;
}

void addPixelLight(const trace::Tracer& tracer, const asset::Asset& asset, const asset::Layer& layer,
                   double minutes, const picture::Viewpoint& viewpoint,
                   const picture::PictureOptions& options, image::Image& picture, Progress& progress) {
  relight::DayRelighter relighter(asset, layer);
  const asset::DayFrames& frames = relighter.frames();
  const Point eye(viewpoint.world_from_camera[3]), its_eye(frames.camera.world_from_camera[3]);
  constexpr float kSamePlace = 1e-3f;  // metres
  if (glm::length(eye - its_eye) > kSamePlace)
    throw Error(ErrorCode::kUsage, "layer " + layer.name,
                fmt::format("is for a camera at {:.3f}, {:.3f}, {:.3f}", its_eye.x, its_eye.y, its_eye.z),
                "show it from there, or bake receivers=atlas for a camera that moves");
  const std::span<const Irradiance> light = relighter.evaluate(minutes);
  picture::PictureOptions albedo = options;
  albedo.view = picture::View::kAlbedo, albedo.background = Vec3(0.0f), albedo.environment = {};
  const image::Image surfaces = picture::render(tracer, nullptr, viewpoint, albedo, progress);
  const picture::PrimaryRays rays(viewpoint, options.width, options.height);
  for (int y = 0; y < options.height; ++y)
    for (int x = 0; x < options.width; ++x) {
      const std::size_t receiver = asset::receiverOf(frames, rays.at(Vec2(x, y) + 0.5f).direction);
      if (receiver == asset::kNowhere)
        throw Error(ErrorCode::kUsage, "layer " + layer.name, "is for a camera that sees less",
                    "take its camera and the shape of its picture, or bake receivers=cube");
      picture.setRgb(x, y, picture.rgb(x, y) + reflected(Albedo(surfaces.rgb(x, y)), light[receiver]).rgb);
    }
}

}  // namespace relume::app
