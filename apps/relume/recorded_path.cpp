// SPDX-License-Identifier: MIT
#include "recorded_path.h"

#include <fmt/format.h>

#include <array>

#include <nlohmann/json.hpp>

#include "relume/core/error.h"
#include "relume/relight/light_set.h"

namespace relume::app {
namespace {

using Json = nlohmann::ordered_json;

Json list(Vec3 v) { return {v.x, v.y, v.z}; }

Json toJson(const Light& l) {
  Json out;
  if (!l.name.empty()) out["name"] = l.name;
  out["color"] = list(l.colour);
  out["intensity"] = l.intensity;
  if (l.kind != Light::Kind::kDirectional) out["position"] = list(l.position);
  switch (l.kind) {
    case Light::Kind::kPoint:
      out["type"] = "point";
      break;
    case Light::Kind::kSpot:
      out["type"] = "spot";
      out["spot"] = {{"innerConeAngle", l.inner_cone}, {"outerConeAngle", l.outer_cone}};
      out["direction"] = list(l.direction);
      break;
    case Light::Kind::kDirectional:
      out["type"] = "directional";
      out["direction"] = list(l.direction);
      break;
    case Light::Kind::kArea:
      out["type"] = "area";
      out["area"] = l.area;
      out["normal"] = list(l.direction);
      out["twoSided"] = l.two_sided;
      break;
  }
  if (l.range < kInfinity && (l.kind == Light::Kind::kPoint || l.kind == Light::Kind::kSpot))
    out["range"] = l.range;
  return out;
}

Vec3 triple(const Json& json, const char* key) {
  const auto v = json.at(key).get<std::array<float, 3>>();
  return {v[0], v[1], v[2]};
}

}  // namespace

std::string toJson(const std::vector<PathFrame>& frames) {
  Json out = {{"frames", Json::array()}};
  Json before;
  for (const PathFrame& f : frames) {
    const Point eye(f.viewpoint.world_from_camera[3]);
    Json frame = {{"eye", list(eye)},
                  {"target", list(eye - glm::normalize(Vec3(f.viewpoint.world_from_camera[2])))},
                  {"fov", glm::degrees(f.viewpoint.vertical_fov)}};
    Json lights = Json::array();
    for (const Light& l : f.lights) lights.push_back(toJson(l));
    if (lights != before) frame["lights"] = lights;
    before = lights;
    for (const Vec3& m : f.moved) frame["moved"].push_back(list(m));
    out["frames"].push_back(frame);
  }
  return out.dump(1) + "\n";
}

std::vector<PathFrame> parsePath(const std::string& text, const std::string& file) {
  std::vector<PathFrame> frames;
  try {
    const Json json = Json::parse(text);
    for (const Json& f : json.at("frames")) {
      PathFrame frame;
      const Point eye = triple(f, "eye"), target = triple(f, "target");
      if (!isFinite(eye) || !isFinite(target) || eye == target)
        throw Error(ErrorCode::kInvalidValue, fmt::format("{}: frame {}", file, frames.size() + 1),
                    "its eye and its target are no two places");
      frame.viewpoint = picture::lookAt(eye, target, glm::radians(f.at("fov").get<float>()));
      if (f.contains("lights"))
        frame.lights = relight::parseLights(f["lights"].dump(), file);
      else if (!frames.empty())
        frame.lights = frames.back().lights;
      if (f.contains("moved"))
        for (const Json& m : f["moved"]) {
          const auto v = m.get<std::array<float, 3>>();
          frame.moved.emplace_back(v[0], v[1], v[2]);
        }
      frames.push_back(std::move(frame));
    }
  } catch (const Json::exception& e) {
    throw Error(ErrorCode::kInvalidJson, file, fmt::format("is no recorded path ({})", e.what()),
                "record one with relume view, key R");
  }
  if (frames.empty()) throw Error(ErrorCode::kInvalidValue, file, "has no frames");
  return frames;
}

}  // namespace relume::app
