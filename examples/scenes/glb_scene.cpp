// SPDX-License-Identifier: MIT
#include "glb_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>

#include "relume/core/check.h"
#include "relume/core/version.h"

namespace relume::scenes {
namespace {

constexpr int kArrayBuffer = 34962, kElementBuffer = 34963, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;

double tidy(double v) { return std::round(v * 1e6) / 1e6 + 0.0; }

nlohmann::ordered_json list(P3 v) { return {tidy(v.x), tidy(v.y), tidy(v.z)}; }
nlohmann::ordered_json list(glm::dquat q) { return {tidy(q.x), tidy(q.y), tidy(q.z), tidy(q.w)}; }

// Turns -z towards `direction`, keeping +y up.
glm::dquat lookAlong(P3 direction) {
  const P3 back = -glm::normalize(direction);
  const P3 up = std::abs(back.y) > 0.999999 ? P3(0, 0, 1) : P3(0, 1, 0);
  const P3 right = glm::normalize(glm::cross(up, back));
  return glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back));
}

void append32(std::vector<std::byte>& out, std::uint32_t v) {
  for (int k = 0; k < 4; ++k) out.push_back(std::byte(v >> (8 * k)));
}

}  // namespace

GlbScene::GlbScene(std::string name) {
  json_["asset"] = {{"version", "2.0"}, {"generator", "relume make_scenes"}};
  json_["extensionsUsed"] = Json::array();
  json_["scene"] = 0;
  json_["scenes"] = Json::array({{{"name", name}, {"nodes", Json::array()}}});
}

std::uint32_t GlbScene::addView(const void* data, std::size_t size, int target) {
  const auto* bytes = static_cast<const std::byte*>(data);
  Json view = {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", size}};
  if (target) view["target"] = target;
  bin_.insert(bin_.end(), bytes, bytes + size);
  bin_.resize((bin_.size() + 3) / 4 * 4);
  json_["bufferViews"].push_back(view);
  return std::uint32_t(json_["bufferViews"].size() - 1);
}

std::uint32_t GlbScene::addAccessor(std::uint32_t view, int component, std::size_t count, const char* type) {
  json_["accessors"].push_back(
      {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
  return std::uint32_t(json_["accessors"].size() - 1);
}

std::uint32_t GlbScene::addMaterial(const MaterialSpec& spec) {
  Json material = {{"name", spec.name},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor",
                      {tidy(spec.base_colour.x), tidy(spec.base_colour.y), tidy(spec.base_colour.z), 1.0}},
                     {"metallicFactor", tidy(spec.metallic)},
                     {"roughnessFactor", tidy(spec.roughness)}}}};
  if (spec.texture) material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", *spec.texture}};
  const double strength = std::max({spec.emission.x, spec.emission.y, spec.emission.z});
  if (strength > 0) {
    material["emissiveFactor"] = list(P3(spec.emission) / std::max(strength, 1.0));
    if (strength > 1)
      material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", tidy(strength)}};
  }
  if (spec.height)
    material["extras"]["relume"]["height"] = {{"index", *spec.height}, {"scale", tidy(spec.height_scale)}};
  if (spec.double_sided) material["doubleSided"] = true;
  json_["materials"].push_back(material);
  return std::uint32_t(json_["materials"].size() - 1);
}

std::uint32_t GlbScene::addTexture(const std::string& name, const std::vector<std::byte>& png) {
  const std::uint32_t view = addView(png.data(), png.size(), 0);
  if (!json_.contains("samplers"))
    json_["samplers"] =
        Json::array({{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}});
  json_["images"].push_back({{"name", name}, {"mimeType", "image/png"}, {"bufferView", view}});
  json_["textures"].push_back({{"source", json_["images"].size() - 1}, {"sampler", 0}});
  return std::uint32_t(json_["textures"].size() - 1);
}

std::uint32_t GlbScene::addMesh(const std::string& name, const MeshBuilder& mesh, double crease_deg) {
  Json primitives = Json::array();
  std::size_t triangles = 0;
  for (const Primitive& part : mesh.primitives(crease_deg)) {
    const std::size_t count = part.positions.size();
    Box3 bounds;
    for (const Point& p : part.positions) bounds.add(p);
    const auto position = addAccessor(addView(part.positions.data(), count * sizeof(Point), kArrayBuffer),
                                      kFloat, count, "VEC3");
    json_["accessors"][position]["min"] = {bounds.lo.x, bounds.lo.y, bounds.lo.z};
    json_["accessors"][position]["max"] = {bounds.hi.x, bounds.hi.y, bounds.hi.z};
    Json attributes = {{"POSITION", position}};
    attributes["NORMAL"] = addAccessor(addView(part.normals.data(), count * sizeof(Normal), kArrayBuffer),
                                       kFloat, count, "VEC3");
    if (!part.uv.empty())
      attributes["TEXCOORD_0"] =
          addAccessor(addView(part.uv.data(), count * sizeof(Vec2), kArrayBuffer), kFloat, count, "VEC2");
    std::uint32_t indices = 0;
    if (count <= 0xffff) {
      std::vector<std::uint16_t> small;
      for (const UVec3& t : part.triangles)
        for (int k = 0; k < 3; ++k) small.push_back(std::uint16_t(t[k]));
      indices = addAccessor(addView(small.data(), small.size() * 2, kElementBuffer), kUnsignedShort,
                            small.size(), "SCALAR");
    } else {
      indices =
          addAccessor(addView(part.triangles.data(), part.triangles.size() * sizeof(UVec3), kElementBuffer),
                      kUnsignedInt, part.triangles.size() * 3, "SCALAR");
    }
    primitives.push_back({{"attributes", attributes}, {"indices", indices}, {"material", part.material}});
    triangles += part.triangles.size();
  }
  RELUME_CHECK(!primitives.empty());
  json_["meshes"].push_back({{"name", name}, {"primitives", primitives}});
  mesh_triangles_.push_back(triangles);
  return std::uint32_t(json_["meshes"].size() - 1);
}

std::uint32_t GlbScene::addLight(const PunctualSpec& spec) {
  Json light = {{"name", spec.name},
                {"type", spec.type},
                {"color", list(P3(spec.colour))},
                {"intensity", tidy(spec.intensity)}};
  if (spec.type == "spot")
    light["spot"] = {{"innerConeAngle", tidy(spec.inner_cone)}, {"outerConeAngle", tidy(spec.outer_cone)}};
  if (!spec.group.empty()) light["extras"] = {{"relume", {{"group", spec.group}}}};
  Json& lights = json_["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(light);
  return std::uint32_t(lights.size() - 1);
}

std::uint32_t GlbScene::place(const std::string& name, std::uint32_t mesh, const Placement& where) {
  Json node = {{"name", name}, {"mesh", mesh}};
  if (where.position != P3(0.0)) node["translation"] = list(where.position);
  if (where.turn_y != 0) node["rotation"] = list(glm::angleAxis(where.turn_y, P3(0, 1, 0)));
  if (where.scale != P3(1.0)) node["scale"] = list(where.scale);
  json_["nodes"].push_back(node);
  const std::uint32_t index = std::uint32_t(json_["nodes"].size() - 1);
  json_["scenes"][0]["nodes"].push_back(index);
  return index;
}

void GlbScene::placeLight(const std::string& name, std::uint32_t light, P3 position, P3 towards) {
  const Json& spec = json_["extensions"]["KHR_lights_punctual"]["lights"][light];
  Json node = {{"name", name}, {"translation", list(position)}};
  if (spec["type"] != "point") node["rotation"] = list(lookAlong(towards - position));
  node["extensions"]["KHR_lights_punctual"] = {{"light", light}};
  if (spec.contains("extras")) node["extras"] = spec["extras"];
  json_["nodes"].push_back(node);
  json_["scenes"][0]["nodes"].push_back(json_["nodes"].size() - 1);
}

void GlbScene::addCamera(const std::string& name, P3 eye, P3 target, double vertical_fov_deg) {
  json_["cameras"].push_back(
      {{"name", name},
       {"type", "perspective"},
       {"perspective", {{"yfov", tidy(vertical_fov_deg * kTau / 360)}, {"znear", 0.05}, {"zfar", 500.0}}}});
  json_["nodes"].push_back({{"name", name},
                            {"camera", json_["cameras"].size() - 1},
                            {"translation", list(eye)},
                            {"rotation", list(lookAlong(target - eye))}});
  json_["scenes"][0]["nodes"].push_back(json_["nodes"].size() - 1);
}

void GlbScene::swing(std::uint32_t node, double angle_deg, double seconds) {
  constexpr int kKeys = 17;
  std::vector<float> times;
  std::vector<glm::vec4> turns;
  for (int k = 0; k < kKeys; ++k) {
    const double phase = double(k) / (kKeys - 1), a = angle_deg * kTau / 360 * std::sin(kTau * phase);
    const auto rounded = [](double v) { return float(std::round(v * 1e6) / 1e6 + 0.0); };
    times.push_back(rounded(seconds * phase));
    turns.push_back({0.0f, 0.0f, rounded(std::sin(a / 2)), rounded(std::cos(a / 2))});
  }
  const auto input = addAccessor(addView(times.data(), times.size() * 4, 0), kFloat, kKeys, "SCALAR");
  json_["accessors"][input]["min"] = {times.front()};
  json_["accessors"][input]["max"] = {times.back()};
  const auto output = addAccessor(addView(turns.data(), turns.size() * 16, 0), kFloat, kKeys, "VEC4");
  if (!json_.contains("animations"))
    json_["animations"] =
        Json::array({{{"name", "swing"}, {"channels", Json::array()}, {"samplers", Json::array()}}});
  Json& animation = json_["animations"][0];
  animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", "rotation"}}}});
}

void GlbScene::note(const std::string& comment) { json_["asset"]["extras"] = {{"description", comment}}; }

std::size_t GlbScene::triangleCount() const {
  std::size_t n = 0;
  for (const Json& node : json_.value("nodes", Json::array()))
    if (node.contains("mesh")) n += mesh_triangles_[node["mesh"].get<std::size_t>()];
  return n;
}

std::size_t GlbScene::lightCount() const {
  return std::size_t(std::count_if(json_["nodes"].begin(), json_["nodes"].end(),
                                   [](const Json& node) { return node.contains("extensions"); }));
}

std::vector<std::byte> GlbScene::glb() const {
  Json json = json_;
  if (json.contains("extensions")) json["extensionsUsed"].push_back("KHR_lights_punctual");
  const auto emits = [](const Json& m) { return m.contains("extensions"); };
  if (std::any_of(json["materials"].begin(), json["materials"].end(), emits))
    json["extensionsUsed"].push_back("KHR_materials_emissive_strength");
  if (json["extensionsUsed"].empty()) json.erase("extensionsUsed");
  json["buffers"] = Json::array({{{"byteLength", bin_.size()}}});
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');

  std::vector<std::byte> out;
  append32(out, 0x46546c67), append32(out, 2), append32(out, std::uint32_t(28 + text.size() + bin_.size()));
  append32(out, std::uint32_t(text.size())), append32(out, 0x4e4f534a);
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  out.insert(out.end(), bytes, bytes + text.size());
  append32(out, std::uint32_t(bin_.size())), append32(out, 0x004e4942);
  out.insert(out.end(), bin_.begin(), bin_.end());
  return out;
}

}  // namespace relume::scenes
