// SPDX-License-Identifier: MIT
// Punctual lights (KHR_lights_punctual) and cameras, placed in the world by the nodes that carry them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "import.h"

namespace relume::scene::gltf {

namespace {

/// The rotation of a transform: lights and cameras do not scale. A side that the transform flattens keeps its
/// default.
Mat3 rotationOf(const Mat4& m) {
  const auto unit = [](Vec3 v, Vec3 fallback) {
    const float length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : fallback;
  };
  const Vec3 z = unit(Vec3(m[2]), {0, 0, 1});
  const Vec3 beside = std::abs(z.y) < 0.9f ? Vec3(0, 1, 0) : Vec3(0, 0, -1);
  const Vec3 y =
      unit(Vec3(m[1]) - glm::dot(Vec3(m[1]), z) * z, glm::normalize(beside - glm::dot(beside, z) * z));
  return {glm::cross(y, z), y, z};
}

Light lightOf(const Value& json) {
  Light light;
  light.name = json["name"].text("");
  light.group = json.group();
  const std::string type = json["type"].text("");
  if (type == "point")
    light.kind = Light::Kind::kPoint;
  else if (type == "spot")
    light.kind = Light::Kind::kSpot;
  else if (type == "directional")
    light.kind = Light::Kind::kDirectional;
  else
    json["type"].fail(ErrorCode::kInvalidValue,
                      fmt::format("is \"{}\", no type of light", type.substr(0, 20)));
  light.colour = glm::max(json["color"].vec3(Vec3(1)), Vec3(0));
  light.intensity = std::max(json["intensity"].real(1), 0.0f);
  const float range = json["range"].real(0);
  light.range = range > 0 ? range : kInfinity;
  const Value spot = json["spot"];
  light.outer_cone = std::clamp(spot["outerConeAngle"].real(kPi / 4), 1e-3f, kPi / 2);
  light.inner_cone = std::clamp(spot["innerConeAngle"].real(0), 0.0f, light.outer_cone);
  return light;
}

}  // namespace

void importLights(Access& access, const std::vector<PlacedNode>& nodes, Scene& scene) {
  const Value json = access.root().extension("KHR_lights_punctual")["lights"];
  std::vector<Light> kinds;
  for (std::size_t i = 0; i < json.size(); ++i) kinds.push_back(lightOf(json.at(i)));
  for (const PlacedNode& node : nodes) {
    const Value reference = access.root()["nodes"].at(node.index).extension("KHR_lights_punctual")["light"];
    if (!reference) continue;
    Light light = kinds[reference.index(kinds.size(), "light")];
    if (light.name.empty()) light.name = node.name;
    if (std::string own = access.root()["nodes"].at(node.index).group(); !own.empty())
      light.group = std::move(own);
    light.position = Point(node.world_from_local[3]);
    light.direction = -rotationOf(node.world_from_local)[2];
    scene.lights.push_back(std::move(light));
  }
}

void importLightBoxes(Access& access, const std::vector<PlacedNode>& nodes, Scene& scene) {
  for (const PlacedNode& node : nodes) {
    const Value notes = access.root()["nodes"].at(node.index).notes();
    if (!notes || !notes["lightBox"]) continue;
    const Vec3 size = notes["lightBox"].vec3(Vec3(0));
    if (!glm::all(glm::greaterThan(size, Vec3(0))))
      notes["lightBox"].fail(ErrorCode::kInvalidValue, "is no box of lengths above 0", "write [x, y, z]");
    Box3 box;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign(corner & 1 ? 0.5f : -0.5f, corner & 2 ? 0.5f : -0.5f, corner & 4 ? 0.5f : -0.5f);
      box.add(Point(node.world_from_local * Vec4(sign * size, 1.0f)));
    }
    scene.light_boxes.push_back(box);
  }
}

void importCameras(Access& access, const std::vector<PlacedNode>& nodes, Scene& scene) {
  const Value cameras = access.root()["cameras"];
  for (const PlacedNode& node : nodes) {
    const Value reference = access.root()["nodes"].at(node.index)["camera"];
    if (!reference) continue;
    const Value json = cameras.at(reference.index(cameras.size(), "camera"));
    Camera& camera = scene.cameras.emplace_back();
    camera.name = json["name"].text(node.name);
    camera.world_from_camera = Mat4(rotationOf(node.world_from_local));
    camera.world_from_camera[3] = node.world_from_local[3];
    camera.orthographic = json["type"].text("perspective") == "orthographic";
    camera.vertical_fov = std::clamp(json["perspective"]["yfov"].real(camera.vertical_fov), 1e-3f, 3.1f);
    camera.ortho_height =
        std::max(2 * std::abs(json["orthographic"]["ymag"].real(camera.ortho_height / 2)), 1e-6f);
  }
}

}  // namespace relume::scene::gltf
