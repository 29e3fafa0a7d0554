// SPDX-License-Identifier: MIT
#include "relume/core/day.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "relume/core/daylight.h"

namespace relume {
namespace {

constexpr double kJustBefore = 1.0 / 60;  // minutes, before a switch

/// Between which two keys a time lies, and how far.
struct Between {
  std::size_t before = 0, after = 0;
  float share = 0;
};

template <class Keys>
Between between(const Keys& keys, double minutes) {
  const auto later = [](double t, const auto& key) { return t < key.minutes; };
  const auto after = std::upper_bound(keys.begin(), keys.end(), minutes, later);
  const auto last = keys.size() - 1;
  if (after != keys.begin() && after != keys.end()) {
    const auto i = static_cast<std::size_t>(after - keys.begin());
    return {i - 1, i,
            static_cast<float>((minutes - keys[i - 1].minutes) / (keys[i].minutes - keys[i - 1].minutes))};
  }
  // Over midnight.
  const double gap = keys[0].minutes + kDayMinutes - keys[last].minutes;
  const double since = minutes - keys[last].minutes + (after == keys.begin() ? kDayMinutes : 0.0);
  return {last, 0, gap > 0 ? static_cast<float>(since / gap) : 0.0f};
}

/// What a lamp's keys say of one of its values, where they say anything; keys without it are passed over.
template <class Value, class Member>
std::optional<Value> valueAt(const std::vector<LightKey>& keys, Member member, double minutes) {
  struct Key {
    double minutes;
    Value value;
  };
  std::vector<Key> known;
  for (const LightKey& key : keys)
    if (key.*member) known.push_back({key.minutes, *(key.*member)});
  if (known.empty()) return {};
  const Between b = between(known, minutes);
  return known[b.before].value + b.share * (known[b.after].value - known[b.before].value);
}

Light at(const KeyedLight& keyed, double minutes) {
  Light light = keyed.light;
  const auto& keys = keyed.keys;
  light.intensity = valueAt<float>(keys, &LightKey::intensity, minutes).value_or(light.intensity);
  light.colour = valueAt<Vec3>(keys, &LightKey::colour, minutes).value_or(light.colour);
  if (const auto place = valueAt<Vec3>(keys, &LightKey::position, minutes)) {
    for (auto& triangle : light.triangles)
      for (Point& corner : triangle) corner += *place - light.position;
    light.position = *place;
  }
  if (const auto d = valueAt<Vec3>(keys, &LightKey::direction, minutes))
    if (glm::length(*d) > 1e-6f) light.direction = glm::normalize(*d);
  return light;
}

bool dark(const Light& light) {
  return !(light.intensity > 0) || !(std::max({light.colour.x, light.colour.y, light.colour.z}) > 0);
}

const std::string& groupName(const Light& light) { return light.group.empty() ? light.name : light.group; }

}  // namespace

double Day::clamped(double minutes) const { return std::clamp(minutes, begin, end); }

SunPosition Day::sunAt(double minutes) const {
  return sunPosition(place, date, clamped(minutes) / 60 - utc_offset);
}

Direction Day::toSun(double minutes) const {
  const SunPosition p = sunAt(minutes);
  return skyDirection(p.azimuth_deg, p.apparent_deg, heading_deg);
}

Vec3 Day::gainAt(const std::string& group, double minutes) const {
  const auto found = groups.find(group);
  if (found == groups.end() || found->second.empty()) return Vec3(1.0f);
  const Between b = between(found->second, clamped(minutes));
  return glm::mix(found->second[b.before].gain, found->second[b.after].gain, b.share);
}

LightSet Day::lampsAt(const LightSet& scene_lights, double minutes) const {
  LightSet lamps;
  const auto add = [&](Light light) {
    light.colour *= gainAt(groupName(light), minutes);
    if (!dark(light)) lamps.push_back(std::move(light));
  };
  if (lights) {
    for (const KeyedLight& keyed : *lights) add(at(keyed, clamped(minutes)));
  } else {
    for (const Light& light : scene_lights)
      if (light.kind != Light::Kind::kDirectional) add(light);
  }
  return lamps;
}

std::optional<Light> Day::sunLightAt(double minutes) const {
  if (!sun) return {};
  const Vec3 lux = scale * sunIlluminance(sunAt(minutes).apparent_deg, turbidity, dayOfYear(date));
  const float most = std::max({lux.x, lux.y, lux.z});
  if (!(most > 0)) return {};
  Light light;
  light.kind = Light::Kind::kDirectional;
  light.name = light.group = "sun";
  light.colour = lux / most, light.intensity = most;
  // While it sets, what is left of the disk is just above the horizon.
  const SunPosition p = sunAt(minutes);
  light.direction = -skyDirection(p.azimuth_deg, std::max(p.apparent_deg, 0.02), heading_deg);
  light.angular_radius = kSunAngularRadius;
  return light;
}

LightSet Day::lightsAt(const LightSet& scene_lights, double minutes) const {
  LightSet all = lampsAt(scene_lights, minutes);
  if (auto light = sunLightAt(minutes)) all.push_back(std::move(*light));
  return all;
}

Vec3 Day::meanSkyAt(double minutes) const {
  if (sky == Sky::kNone) return Vec3(0.0f);
  const double elevation = sunAt(minutes).elevation_deg;
  // Clear skies are bluer the lower the sun: CIE chromaticities of 10,000 K by day and 20,000 K at dusk.
  constexpr Vec3 kByDay(0.78f, 1.0f, 1.46f), kAtDusk(0.66f, 1.0f, 1.85f);
  const Vec3 tint = glm::mix(kAtDusk, kByDay, static_cast<float>(std::clamp((elevation + 6) / 26, 0.0, 1.0)));
  return tint * (scale * static_cast<float>(skyIlluminance(elevation) / M_PI) / luminance(tint));
}

std::vector<double> Day::breaks() const {
  std::vector<double> times{begin, end};
  const auto add = [&](double minutes) {
    minutes = std::fmod(std::fmod(minutes, kDayMinutes) + kDayMinutes, kDayMinutes);
    if (minutes > begin && minutes < end) times.push_back(minutes);
  };
  const auto addKeys = [&](const auto& keys) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (i > 0 && keys[i].minutes == keys[i - 1].minutes) add(keys[i].minutes - kJustBefore);
      add(keys[i].minutes);
    }
  };
  for (const auto& [name, keys] : groups) addKeys(keys);
  if (lights)
    for (const KeyedLight& keyed : *lights) addKeys(keyed.keys);
  if (sun) {
    const SunTimes t = sunTimes(place, date);
    add((t.noon + utc_offset) * 60);
    if (t.rise) add((*t.rise + utc_offset) * 60);
    if (t.set) add((*t.set + utc_offset) * 60);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::string clockText(double minutes) {
  const auto seconds = static_cast<long>(std::lround(minutes * 60));
  const long h = seconds / 3600, m = seconds / 60 % 60, s = seconds % 60;
  return s == 0 ? fmt::format("{:02}:{:02}", h, m) : fmt::format("{:02}:{:02}:{:02}", h, m, s);
}

std::optional<double> clockMinutes(const std::string& text) {
  std::array<int, 3> part{};
  std::size_t count = 0, digits = 0;
  for (const char c : text) {
    if (c == ':') {
      if (digits == 0 || ++count > 2) return {};
      digits = 0;
    } else if (c >= '0' && c <= '9' && ++digits <= 2) {
      part[count] = 10 * part[count] + (c - '0');
    } else {
      return {};
    }
  }
  if (count == 0 || digits != 2 || part[1] > 59 || part[2] > 59) return {};
  const double minutes = 60.0 * part[0] + part[1] + part[2] / 60.0;
  return minutes <= kDayMinutes ? std::optional(minutes) : std::nullopt;
}

}  // namespace relume
