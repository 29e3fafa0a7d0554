// SPDX-License-Identifier: MIT
#include "relume/relight/day_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "relume/core/error.h"
#include "relume/relight/light_set.h"

namespace relume::relight {
namespace {

using Json = nlohmann::json;

class DayReader {
 public:
  DayReader(const Json& json, std::string file) : json_(json), file_(std::move(file)) {}

  [[noreturn]] void fail(const std::string& where, const std::string& problem,
                         const std::string& remedy = {}) const {
    throw Error(ErrorCode::kInvalidValue, file_, where + " " + problem, remedy);
  }

  void allowOnly(const Json& object, const std::string& where,
                 std::initializer_list<const char*> fields) const {
    if (!object.is_object()) fail(where, "is not an object");
    for (const auto& [key, value] : object.items())
      if (std::find(fields.begin(), fields.end(), key) == fields.end())
        fail(where + (where.empty() ? "" : ".") + key, "is not known here",
             fmt::format("it has: {}", fmt::join(fields, ", ")));
  }

  double number(const Json& value, const std::string& where, double lowest, double highest) const {
    if (!value.is_number()) fail(where, "is not a number");
    const auto x = value.get<double>();
    if (!(x >= lowest && x <= highest))
      fail(where, fmt::format("is {}, not from {} to {}", x, lowest, highest));
    return x;
  }

  Vec3 triple(const Json& value, const std::string& where, double lowest) const {
    if (!value.is_array() || value.size() != 3) fail(where, "is not a list of 3 numbers");
    Vec3 v;
    for (int c = 0; c < 3; ++c)
      v[c] = static_cast<float>(number(value[static_cast<std::size_t>(c)], where, lowest, kMost));
    return v;
  }

  double clock(const Json& value, const std::string& where) const {
    const auto minutes = value.is_string() ? clockMinutes(value.get<std::string>()) : std::nullopt;
    if (!minutes) fail(where, "is no time of the day", "write \"HH:MM\", up to \"24:00\"");
    return *minutes;
  }

  Day read() const {
    allowOnly(json_, "",
              {"latitude", "longitude", "date", "utcOffset", "heading", "turbidity", "scale", "sun", "sky",
               "begin", "end", "groups", "lights", "extras"});
    Day day;
    const auto set = [&](const char* field, auto& value, double lowest, double highest) {
      if (json_.contains(field))
        value = static_cast<std::remove_reference_t<decltype(value)>>(
            number(json_[field], field, lowest, highest));
    };
    set("latitude", day.place.latitude_deg, -90, 90);
    set("longitude", day.place.longitude_deg, -180, 180);
    set("utcOffset", day.utc_offset, -12, 14);
    set("heading", day.heading_deg, -360, 360);
    set("turbidity", day.turbidity, 2, 10);
    set("scale", day.scale, 0, kMost);
    if (json_.contains("date")) day.date = date();
    if (json_.contains("sun")) {
      if (!json_["sun"].is_boolean()) fail("sun", "is not true or false");
      day.sun = json_["sun"].get<bool>();
    }
    if (json_.contains("sky")) day.sky = sky();
    if (json_.contains("begin")) day.begin = clock(json_["begin"], "begin");
    if (json_.contains("end")) day.end = clock(json_["end"], "end");
    if (!(day.begin < day.end)) fail("end", "is not after begin");
    if (json_.contains("groups")) readGroups(day);
    if (json_.contains("lights")) readLights(day);
    return day;
  }

 private:
  static constexpr double kMost = 3e38;

  Date date() const {
    Date d;
    char rest = 0;
    const bool text = json_["date"].is_string();
    if (!text ||
        std::sscanf(json_["date"].get<std::string>().c_str(), "%4d-%2d-%2d%c", &d.year, &d.month, &d.day,
                    &rest) != 3 ||
        !isValid(d))
      fail("date", "is no date", "write \"YYYY-MM-DD\", from 1800 to 2200");
    return d;
  }

  Day::Sky sky() const {
    const std::string word = json_["sky"].is_string() ? json_["sky"].get<std::string>() : "";
    if (word == "model") return Day::Sky::kModel;
    if (word == "constant") return Day::Sky::kConstant;
    if (word == "none") return Day::Sky::kNone;
    fail("sky", "is not known", "one of model, constant, none");
  }

  template <class Keys>
  void requireOrder(const Keys& keys, const std::string& where) const {
    if (keys.empty()) fail(where, "has no key");
    if (!std::is_sorted(keys.begin(), keys.end(),
                        [](const auto& a, const auto& b) { return a.minutes < b.minutes; }))
      fail(where, "has keys that are not in the order of time");
  }

  void readGroups(Day& day) const {
    if (!json_["groups"].is_object()) fail("groups", "is not an object");
    for (const auto& [name, list] : json_["groups"].items()) {
      const std::string where = "groups." + name;
      if (!list.is_array()) fail(where, "is not a list of [time, gain]");
      std::vector<GainKey>& keys = day.groups[name];
      for (const Json& pair : list) {
        if (!pair.is_array() || pair.size() != 2) fail(where, "has a key that is not [time, gain]");
        GainKey key{.minutes = clock(pair[0], where)};
        key.gain = pair[1].is_array() ? triple(pair[1], where, 0)
                                      : Vec3(static_cast<float>(number(pair[1], where, 0, kMost)));
        keys.push_back(key);
      }
      requireOrder(keys, where);
    }
  }

  void readLights(Day& day) const {
    if (!json_["lights"].is_array()) fail("lights", "is not a list of lights");
    Json bare = json_["lights"];
    for (Json& light : bare)
      if (light.is_object()) light.erase("keys");
    day.lights.emplace();
    for (Light& light : parseLights(bare.dump(-1, ' ', false, Json::error_handler_t::replace), file_))
      day.lights->push_back({std::move(light), {}});
    for (std::size_t i = 0; i < day.lights->size(); ++i) {
      const Json& light = json_["lights"][i];
      if (!light.contains("keys")) continue;
      const std::string where = fmt::format("lights[{}].keys", i);
      if (!light["keys"].is_array()) fail(where, "is not a list");
      std::vector<LightKey>& keys = (*day.lights)[i].keys;
      for (const Json& key : light["keys"]) keys.push_back(readKey(key, where));
      requireOrder(keys, where);
    }
  }

  LightKey readKey(const Json& json, const std::string& where) const {
    allowOnly(json, where, {"time", "intensity", "color", "position", "direction"});
    if (!json.contains("time")) fail(where, "has a key without a time");
    LightKey key{.minutes = clock(json["time"], where + ".time")};
    if (json.contains("intensity"))
      key.intensity = static_cast<float>(number(json["intensity"], where + ".intensity", 0, kMost));
    if (json.contains("color")) key.colour = triple(json["color"], where + ".color", 0);
    if (json.contains("position")) key.position = triple(json["position"], where + ".position", -kMost);
    if (json.contains("direction")) {
      const Vec3 d = triple(json["direction"], where + ".direction", -kMost);
      if (!(glm::length(d) > 0 && glm::length(d) < kInfinity)) fail(where + ".direction", "is zero");
      key.direction = glm::normalize(d);
    }
    return key;
  }

  const Json& json_;
  const std::string file_;
};

}  // namespace

Day parseDay(std::string_view json, const std::string& name) {
  const Json root = Json::parse(json, nullptr, false);
  if (root.is_discarded()) throw Error(ErrorCode::kInvalidJson, name, "is not valid JSON");
  return DayReader(root, name).read();
}

}  // namespace relume::relight
