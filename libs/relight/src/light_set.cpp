// SPDX-License-Identifier: MIT
#include "relume/relight/light_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "relume/core/error.h"
#include "relume/core/polygon.h"

namespace relume::relight {
namespace {

using Json = nlohmann::json;

// One object of the list. Every member must be known and have its place: a misspelt "intesity" is an error,
// not a light of 1 cd.
class LightReader {
 public:
  LightReader(const Json& json, std::string file, std::size_t index)
      : LightReader(json, std::move(file), fmt::format("lights[{}]", index)) {}
  LightReader(const Json& json, std::string file, std::string where)
      : json_(json), file_(std::move(file)), where_(std::move(where)) {
    if (!json_.is_object()) fail("", "is not an object");
  }

  [[noreturn]] void fail(const std::string& field, const std::string& problem,
                         const std::string& remedy = {}) const {
    throw Error(ErrorCode::kInvalidValue, file_, where_ + (field.empty() ? "" : "." + field) + " " + problem,
                remedy);
  }

  const Json* find(const char* field) const {
    const auto it = json_.find(field);
    return it == json_.end() ? nullptr : &*it;
  }

  std::string text(const char* field) const {
    const Json* value = find(field);
    if (!value) return {};
    if (!value->is_string()) fail(field, "is not a string");
    return value->get<std::string>();
  }

  /// A number in [lowest, highest].
  std::optional<float> number(const char* field, float lowest, float highest) const {
    return numberOf(find(field), field, lowest, highest);
  }

  std::optional<Vec3> vector(const char* field, float lowest, float highest) const {
    const Json* value = find(field);
    if (!value) return {};
    return vectorOf(*value, field, lowest, highest);
  }

  std::vector<Vec3> vectors(const char* field) const {
    const Json* value = find(field);
    if (!value->is_array()) fail(field, "is not a list");
    std::vector<Vec3> list;
    for (std::size_t i = 0; i < value->size(); ++i)
      list.push_back(vectorOf((*value)[i], fmt::format("{}[{}]", field, i), -kMax, kMax));
    return list;
  }

  bool flag(const char* field) const {
    const Json* value = find(field);
    if (!value) return false;
    if (!value->is_boolean()) fail(field, "is not true or false");
    return value->get<bool>();
  }

  Direction direction(const char* field) const {
    const std::optional<Vec3> v = vector(field, -kMax, kMax);
    if (!v) fail(field, "is missing");
    // Through the largest component, so that no square leaves the range of a float.
    const float largest = std::max({std::abs(v->x), std::abs(v->y), std::abs(v->z)});
    if (!(largest > 0)) fail(field, "is zero");
    return glm::normalize(*v / largest);
  }

  void allowOnly(std::initializer_list<const char*> fields) const {
    std::string known;
    for (const char* f : fields) known += std::string(known.empty() ? "" : ", ") + f;
    for (const auto& [key, value] : json_.items())
      if (std::find(fields.begin(), fields.end(), key) == fields.end())
        fail(key, "is not a field of such a light", "it has: " + known);
  }

  LightReader inner(const char* field) const {
    LightReader reader = *this;
    reader.where_ += std::string(".") + field;
    reader.json_ = *find(field);
    if (!reader.json_.is_object()) fail(field, "is not an object");
    return reader;
  }

  static constexpr float kMax = std::numeric_limits<float>::max();

 private:
  std::optional<float> numberOf(const Json* value, const std::string& field, float lowest,
                                float highest) const {
    if (!value) return {};
    if (!value->is_number()) fail(field, "is not a number");
    const auto x = value->get<double>();
    if (!(x >= lowest && x <= highest))
      fail(field, highest < kMax ? fmt::format("is {}, not from {} to {}", x, lowest, highest)
                  : lowest == 0  ? fmt::format("is {}, not a number from 0 up", x)
                                 : fmt::format("is {}, too large", x));
    return static_cast<float>(x);
  }

  Vec3 vectorOf(const Json& value, const std::string& field, float lowest, float highest) const {
    if (!value.is_array() || value.size() != 3) fail(field, "is not a list of 3 numbers");
    Vec3 v;
    for (std::size_t c = 0; c < 3; ++c)
      v[static_cast<int>(c)] = *numberOf(&value[c], fmt::format("{}[{}]", field, c), lowest, highest);
    return v;
  }

  Json json_;
  std::string file_, where_;
};

Light::Kind kindOf(const LightReader& reader) {
  static constexpr std::array<std::pair<const char*, Light::Kind>, 4> kKinds{
      {{"point", Light::Kind::kPoint},
       {"spot", Light::Kind::kSpot},
       {"directional", Light::Kind::kDirectional},
       {"area", Light::Kind::kArea}}};
  const std::string type = reader.text("type");
  for (const auto& [name, kind] : kKinds)
    if (type == name) return kind;
  reader.fail("type", type.empty() ? "is missing" : fmt::format("is \"{}\"", type),
              "one of point, spot, directional, area");
}

void allowOnlyFieldsOf(Light::Kind kind, const LightReader& reader) {
  switch (kind) {
    case Light::Kind::kPoint:
      return reader.allowOnly({"type", "name", "group", "color", "intensity", "range", "position", "extras"});
    case Light::Kind::kSpot:
      return reader.allowOnly({"type", "name", "group", "color", "intensity", "range", "position",
                               "direction", "spot", "extras"});
    case Light::Kind::kDirectional:
      return reader.allowOnly({"type", "name", "group", "color", "intensity", "direction", "position",
                               "angularDiameter", "extras"});
    case Light::Kind::kArea:
      return reader.find("vertices") ? reader.allowOnly({"type", "name", "group", "color", "intensity",
                                                         "vertices", "twoSided", "extras"})
                                     : reader.allowOnly({"type", "name", "group", "color", "intensity",
                                                         "position", "normal", "area", "twoSided", "extras"});
  }
}

void readCone(const LightReader& reader, Light& light) {
  if (!reader.find("spot")) return;
  const LightReader spot = reader.inner("spot");
  spot.allowOnly({"innerConeAngle", "outerConeAngle", "extras"});
  light.inner_cone = spot.number("innerConeAngle", 0, kPi / 2).value_or(light.inner_cone);
  light.outer_cone = spot.number("outerConeAngle", 0, kPi / 2).value_or(light.outer_cone);
  if (!(light.inner_cone < light.outer_cone))
    spot.fail("innerConeAngle",
              fmt::format("is {}, not less than outerConeAngle, {}", light.inner_cone, light.outer_cone));
}

float positive(const LightReader& reader, const char* field, float value) {
  if (!(value > 0)) reader.fail(field, "is not above 0");
  return value;
}

void readDisk(const LightReader& reader, Light& light) {
  light.direction = reader.direction("normal");
  const auto area = reader.number("area", 0, LightReader::kMax);
  if (!area) reader.fail("area", "is missing");
  light.area = positive(reader, "area", *area);
}

void readPolygon(const LightReader& reader, Light& light) {
  constexpr std::size_t kMostCorners = 1024;
  constexpr double kFlat = 1e-3;  // how far a corner may be off the plane, in the root of the area
  const std::vector<Point> corners = reader.vectors("vertices");
  if (corners.size() < 3 || corners.size() > kMostCorners)
    reader.fail("vertices", fmt::format("has {} corners, not from 3 to {}", corners.size(), kMostCorners));
  const glm::dvec3 area = areaVector(corners);
  const double size = glm::length(area);
  light.area = static_cast<float>(size);
  if (!(light.area > 0 && light.area < kInfinity))
    reader.fail("vertices", "enclose no area that a number can tell");
  light.direction = Direction(area / size);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double off = glm::dot(glm::dvec3(corners[i]) - glm::dvec3(corners[0]), area / size);
    if (std::abs(off) > kFlat * std::sqrt(size))
      reader.fail(
          "vertices",
          fmt::format("do not lie in a plane: the one of index {} is {:.2g} m off it", i, std::abs(off)),
          "make several lights of it");
  }
  light.triangles = triangulate(corners);
  if (light.triangles.empty())
    reader.fail("vertices", "make an outline that meets itself", "make several lights of it");
  glm::dvec3 middle(0);
  double whole = 0;
  for (const auto& [a, b, c] : light.triangles) {
    const double part = glm::length(areaVector(std::array{a, b, c}));
    middle += part / 3 * (glm::dvec3(a) + glm::dvec3(b) + glm::dvec3(c)), whole += part;
  }
  light.position = Point(middle / whole);
}

Light readLight(const LightReader& reader) {
  constexpr float kMax = LightReader::kMax;
  Light light;
  light.kind = kindOf(reader);
  allowOnlyFieldsOf(light.kind, reader);
  light.name = reader.text("name");
  light.group = reader.text("group");
  light.colour = reader.vector("color", 0, kMax).value_or(light.colour);
  light.intensity = reader.number("intensity", 0, kMax).value_or(light.intensity);
  if (const auto range = reader.number("range", 0, kMax)) light.range = positive(reader, "range", *range);
  if (const auto position = reader.vector("position", -kMax, kMax)) {
    light.position = *position;
  } else if (light.kind != Light::Kind::kDirectional && !reader.find("vertices")) {
    reader.fail("position", "is missing");
  }
  if (light.kind == Light::Kind::kSpot || light.kind == Light::Kind::kDirectional)
    light.direction = reader.direction("direction");
  if (light.kind == Light::Kind::kSpot) readCone(reader, light);
  if (light.kind == Light::Kind::kDirectional)
    light.angular_radius = 0.5f * reader.number("angularDiameter", 0, kPi).value_or(0.0f);
  if (light.kind == Light::Kind::kArea) {
    light.two_sided = reader.flag("twoSided");
    reader.find("vertices") ? readPolygon(reader, light) : readDisk(reader, light);
  }
  return light;
}

EnvironmentSource readEnvironment(const LightReader& reader) {
  constexpr float kMax = LightReader::kMax;
  reader.allowOnly({"radiance", "file", "rotation", "sky", "name", "extras"});
  EnvironmentSource source;
  source.file = reader.text("file");
  source.rotation = reader.number("rotation", -kMax, kMax).value_or(0.0f);
  const auto radiance = reader.vector("radiance", 0, kMax);
  source.radiance = radiance.value_or(source.radiance);
  if (reader.find("sky")) {
    if (!source.file.empty()) reader.fail("sky", "stands beside a file", "give one of them");
    const LightReader sky = reader.inner("sky");
    sky.allowOnly({"direction", "turbidity", "extras"});
    source.sky.emplace();
    source.sky->sun_direction = sky.direction("direction");
    if (!(source.sky->sun_direction.y < 0)) sky.fail("direction", "leaves the sun below the horizon");
    source.sky->turbidity = sky.number("turbidity", 2, 10).value_or(source.sky->turbidity);
  } else if (source.file.empty() && !radiance) {
    reader.fail("radiance", "is missing", "give a radiance, a file or a sky");
  }
  return source;
}

Json parseJson(std::string_view json, const std::string& name) {
  Json root = Json::parse(json, nullptr, false);
  if (root.is_discarded()) throw Error(ErrorCode::kInvalidJson, name, "is not valid JSON");
  return root;
}

}  // namespace

LightSet parseLights(std::string_view json, const std::string& name) {
  const Json root = parseJson(json, name);
  if (root.is_object() && root.contains("environment") && !root.contains("lights")) return {};
  const Json& list = root.is_object() && root.contains("lights") ? root["lights"] : root;
  if (!list.is_array())
    throw Error(ErrorCode::kInvalidValue, name, "is not a list of lights",
                "write [ {\"type\": \"point\", ...}, ... ]");
  LightSet lights;
  for (std::size_t i = 0; i < list.size(); ++i) lights.push_back(readLight(LightReader(list[i], name, i)));
  return lights;
}

std::optional<EnvironmentSource> parseEnvironment(std::string_view json, const std::string& name) {
  const Json root = parseJson(json, name);
  if (!root.is_object() || !root.contains("environment")) return {};
  return readEnvironment(LightReader(root["environment"], name, "environment"));
}

}  // namespace relume::relight
